#include "trace/technique_files.h"

#include "trace/lab_passes.h"

#include <algorithm>
#include <functional>
#include <iterator>

namespace ssrlab {

TechniqueFiles technique_files(Gpu& gpu, const LabPtr& lab)
{
    const RayBuffers rays = make_ray_buffers(gpu, 1, NumberFormat::float32);
    TechniqueFiles   files;
    const auto       add = [&](std::vector<ShaderFile>& list, const ShaderSource& source) {
        const auto known = [&](const ShaderFile& file) {
            const auto same = [&](const ShaderFile& other) { return other.name == file.name; };
            return std::ranges::any_of(files.technique, same) || std::ranges::any_of(files.ray_setup, same);
        };
        std::ranges::copy_if(shader_files(gpu, source), std::back_inserter(list), std::not_fn(known));
    };
    add(files.technique, trace_source(gpu, *lab, rays, {}));
    for (const ShaderSource& source : structure_sources(gpu, *lab, rays)) add(files.technique, source);
    add(files.ray_setup, ray_setup_source(gpu, rays));
    return files;
}

} // namespace ssrlab
