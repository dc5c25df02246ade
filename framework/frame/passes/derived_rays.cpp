#include "frame/passes/pass_helpers.h"

#include <algorithm>

namespace ssrlab {

std::shared_ptr<DerivedRays> derived_rays(Gpu& gpu, const PassContext& context, int which)
{
    const size_t                  capacity = context.frame.rays->capacity;
    std::shared_ptr<DerivedRays>& derived  = context.frame.buffers->derived_rays[{capacity, which}];
    if (!derived) {
        const uint64_t rays = std::max<uint64_t>(capacity, 1);
        derived             = std::make_shared<DerivedRays>(DerivedRays{
            make_ray_buffers(gpu, capacity, NumberFormat::float32), make_buffer(gpu, rays * sizeof(uint32_t)),
            make_buffer(gpu, rays * sizeof(glm::vec3), sizeof(glm::vec3))});
    }
    return derived;
}

Bindings derived_bindings(const DerivedRays& derived)
{
    return {{"DerivedCount", derived.rays.count},
            {"DerivedRays", derived.rays.list},
            {"DerivedHits", derived.rays.hits},
            {"DerivedSources", derived.sources},
            {"DerivedThroughputs", derived.throughputs}};
}

} // namespace ssrlab
