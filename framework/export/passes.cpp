#include "export/passes.h"

#include "core/error.h"
#include "export/glsl.h"
#include "shared.h"
#include "trace/lab_passes.h"

#include <algorithm>

namespace ssrlab {
namespace {

ComposedPass own_pass(const Lab& lab, const char* file)
{
    return {"",
            compose_shader(lab, file),
            compose_constants(lab),
            0,
            {},
            {groups_of_8(lab.gbuffer->view.size_px)},
            "8 x 8 px a workgroup"};
}

std::string name_of(const ComposedPass& pass, size_t number)
{
    const std::string stem = pass.source.file.stem().string();
    if (pass.structure.empty()) return fmt::format("{}_{}", number, stem.starts_with("trace") ? "trace" : stem);
    return fmt::format("{}_{}_{}", number, pass.structure, stem);
}

} // namespace

std::vector<ExportedPass> export_passes(Gpu& gpu, const Lab& lab, const ComposedLab& composed,
                                        const std::set<std::string>& kept)
{
    if (lab.settings.layers > 1)
        throw_spec_error("layers = {}: an export traces the first layer only; use layers = 1", lab.settings.layers);
    std::vector<ComposedPass> passes{own_pass(lab, "export/depth.comp")};
    const auto                reads_rays = [](const ComposedPass& pass) { return pass.rays_per_workgroup > 0; };
    const auto                first      = std::ranges::find_if(composed.passes, reads_rays);
    passes.insert(passes.end(), composed.passes.begin(), first);
    passes.push_back(own_pass(lab, "export/rays.comp"));
    passes.back().source.defines.merge(number_format_defines(gpu, NumberFormat::float32));
    const size_t set_up = passes.size() - 1;
    passes.insert(passes.end(), first, composed.passes.end());

    std::vector<ExportedPass> exported;
    for (size_t i = 0; i < passes.size(); ++i)
        exported.push_back({name_of(passes[i], i + 1), export_glsl(gpu, passes[i].source, passes[i].constants, kept),
                            passes[i], i == set_up});
    return exported;
}

std::string resource_of(const std::string& name, const ComposedLab& composed, const std::string& file)
{
    static const std::map<std::string, std::string> known = {
        {"View", "view"},         {"HostDepth", "host_depth"}, {"HostGradients", "host_gradients"},
        {"depth_cells", "cells"}, {"cell_pairs", "cells"},     {"StoredCells", "cells"},
        {"StoredCell", "cells"},  {"depth_words", "cells"},    {"StoredPlanes", "cells"},
        {"cells_both", "cells"},  {"RayCount", "ray_count"},   {"Rays", "rays"},
        {"Hits", "hits"},         {"normal_image", "normals"}, {"solid_image", "solids"},
        {"Push", "push"}};
    if (const auto found = known.find(name); found != known.end()) return found->second;
    for (const ComposedBuffer& buffer : composed.buffers)
        if (name == buffer.name + "_loaded" || name == buffer.name + "_stored" || name == buffer.name + "_both")
            return buffer.structure + "." + buffer.name;
    throw_spec_error("{}: '{}' is a resource that an export does not have", file, name);
}

} // namespace ssrlab
