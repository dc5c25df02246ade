#include "frame/passes/pass_helpers.h"

namespace ssrlab {

std::span<const Pass> all_passes()
{
    static const std::vector<Pass> passes = {
        layers_pass(),         solid_backs_pass(),
        classification_pass(), rays_pass(),
        structures_pass(),     trace_pass(),
        hidden_layer_pass(),   missed_rays_pass(),
        reprojection_pass(),   colour_downsampling_pass(),
        cone_pyramid_pass(),   hit_colour_pass(),
        bounces_pass(),        ray_blur_pass(),
        upsampling_pass(),     ray_reuse_pass(),
        filter_3x3_pass(),     blur_pass(),
        environment_pass(),    history_pass(),
        composite_pass(),      picture_history_pass(),
    };
    return passes;
}

std::vector<Parameter> plan_parameters()
{
    return {boolean_parameter("skip_unneeded_passes", true,
                              "skip passes that the frame does not need; false: run every pass that is not off, on "
                              "every pixel with a surface"),
            choice_parameter(PassSet::all, "passes that may run: all, or only tracing and shading")};
}

std::span<const Parameter> pass_parameters()
{
    static const std::vector<Parameter> parameters = [] {
        std::vector<Parameter> all = plan_parameters();
        for (const Pass& pass : all_passes()) all.insert(all.end(), pass.parameters.begin(), pass.parameters.end());
        return all;
    }();
    return parameters;
}

ParameterValues default_pass_values()
{
    ParameterValues values;
    for (const Parameter& parameter : pass_parameters()) values[parameter.name] = parameter.default_value;
    return values;
}

} // namespace ssrlab
