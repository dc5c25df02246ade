// What the lab's shaders wrote.
#include "trace/lab_passes.h"

#include "core/pixel_index.h"
#include "shared.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>

namespace ssrlab {

uint32_t pack_pixel(glm::ivec2 pixel, int number)
{
    return static_cast<uint32_t>(pixel.x) | static_cast<uint32_t>(pixel.y) << PIXEL_BITS |
           static_cast<uint32_t>(number) << (2 * PIXEL_BITS);
}

glm::ivec2 unpack_pixel(uint32_t packed)
{
    return {packed & (MAX_IMAGE_PX - 1), (packed >> PIXEL_BITS) & (MAX_IMAGE_PX - 1)};
}

TraceStatus unpack_status(uint32_t packed)
{
    return static_cast<TraceStatus>(number_to_status(static_cast<int>(packed >> (2 * PIXEL_BITS))));
}

uint8_t unpack_layer(uint32_t packed)
{
    return static_cast<uint8_t>(number_to_layer(static_cast<int>(packed >> (2 * PIXEL_BITS))));
}

size_t work_words(const Technique& technique) { return 2 + std::max<size_t>(technique.structures.size(), 1); }

template <typename Real> TraceImage read_result(Gpu& gpu, const Lab& lab, const RayBuffers& rays, const Buffer* work)
{
    const glm::ivec2 size_px    = lab.gbuffer->view.size_px;
    const auto&      structures = lab.technique.structures;
    const auto       listed     = read_list<Real>(gpu, rays);
    const size_t     count = listed.size(), words = work_words(lab.technique);
    const auto       hits = download_as<PackedHit<Real>>(gpu, rays.hits, count);
    const auto works = work != nullptr ? download_as<uint32_t>(gpu, *work, count * words) : std::vector<uint32_t>{};
    const auto group_fetches = work != nullptr ? read_group_fetches(gpu, lab.technique, rays)
                                               : std::vector<std::vector<uint32_t>>(structures.size());
    TraceImage result        = make_trace_image(size_px, work != nullptr);
    for (const Structure& structure : structures)
        if (work != nullptr)
            result.structure_fetches.push_back({structure.id, std::vector<uint32_t>(pixel_count(size_px))});
    for (size_t i = 0; i < count; ++i) {
        const glm::ivec2 pixel = unpack_pixel(listed[i].pixel);
        const size_t     index = pixel_index(pixel, size_px);
        result.traced_order.push_back(index);
        result.status[index]       = unpack_status(hits[i].pixel);
        result.hit_pixel[index]    = unpack_pixel(hits[i].pixel);
        result.hit_layer[index]    = unpack_layer(hits[i].pixel);
        result.hit_t[index]        = static_cast<double>(hits[i].t);
        result.hit_px_depth[index] = glm::dvec3(listed[i].origin) + result.hit_t[index] * glm::dvec3(listed[i].delta);
        if (work == nullptr) continue;
        if (result.status[index] == TraceStatus::impossible) {
            result.steps[index]     = works[i * words];
            result.hit_pixel[index] = {static_cast<int>(works[i * words + 1]), static_cast<int>(works[i * words + 2])};
            continue;
        }
        result.steps[index]         = works[i * words];
        result.depth_fetches[index] = works[i * words + 1];
        for (size_t s = 0; s < structures.size(); ++s) {
            uint32_t& fetches = result.structure_fetches[s].fetches[index];
            fetches           = works[i * words + 2 + s];
            // Those for a whole group of rays count once, with its first ray.
            if (i % RAYS_PER_GROUP == 0 && !group_fetches[s].empty()) fetches += group_fetches[s][i / RAYS_PER_GROUP];
        }
    }
    return result;
}
template TraceImage read_result<float>(Gpu&, const Lab&, const RayBuffers&, const Buffer*);
template TraceImage read_result<double>(Gpu&, const Lab&, const RayBuffers&, const Buffer*);

float half_to_float(uint16_t half) { return glm::unpackHalf1x16(half); }

} // namespace ssrlab
