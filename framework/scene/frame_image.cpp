#include "scene/load_frame.h"

#include "core/error.h"

namespace ssrlab {
namespace {

std::string matrix_text(const glm::dmat4& matrix)
{
    std::string text;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            text += fmt::format("{}{:.17g}", text.empty() ? "" : " ", matrix[column][row]);
    return text;
}

std::string pair_text(glm::dvec2 pair) { return fmt::format("{:.17g} {:.17g}", pair.x, pair.y); }

} // namespace

Image frame_image(const GBufferImage& source)
{
    const View& view        = source.view;
    const bool  perspective = view.projection == Projection::perspective;
    Image       image{
        view.size_px,
        {"depth",         "normal_vs.x",   "normal_vs.y", "normal_vs.z", "roughness",  "metallic",     "base_colour.R",
               "base_colour.G", "base_colour.B", "R",           "G",           "B",          "radiance.R",   "radiance.G",
               "radiance.B",    "highlight.R",   "highlight.G", "highlight.B", "object_id",  "gradient.x",   "gradient.y",
               "solid_back",    "dielectric_f0", "emission.R",  "emission.G",  "emission.B", "diffuse_share"},
        {},
        {}};
    image.metadata["ssrlab:world_to_view"] = matrix_text(view.world_to_view);
    image.metadata["ssrlab:view_to_clip"]  = matrix_text(view_to_clip(view));
    image.metadata["ssrlab:focal_px"]      = pair_text(view.focal_px);
    image.metadata["ssrlab:centre_px"]     = pair_text(view.centre_px);
    image.metadata["ssrlab:depth"]  = perspective ? "near_m / distance_m" : "(far_m - distance_m) / (far_m - near_m)";
    image.metadata["ssrlab:near_m"] = fmt::format("{:.17g}", view.near_m);
    image.metadata["ssrlab:far_m"]  = perspective ? "inf" : fmt::format("{:.17g}", view.far_m);
    const bool moved                = !source.motion_px.empty();
    if (moved) image.channels.insert(image.channels.end(), {"motion_px.x", "motion_px.y"});
    image.values.reserve(source.depth.size() * image.channels.size());
    for (size_t i = 0; i < source.depth.size(); ++i) {
        const glm::vec3 normal = source.normal_vs[i], base = source.base_colour[i], radiance = source.radiance[i],
                        highlight = source.highlight[i], lit = radiance + highlight, emission = emission_at(source, i);
        const glm::vec2 gradient = source.gradient[i];
        for (const float value : {source.depth[i],
                                  normal.x,
                                  normal.y,
                                  normal.z,
                                  source.roughness[i],
                                  source.metallic[i],
                                  base.x,
                                  base.y,
                                  base.z,
                                  lit.x,
                                  lit.y,
                                  lit.z,
                                  radiance.x,
                                  radiance.y,
                                  radiance.z,
                                  highlight.x,
                                  highlight.y,
                                  highlight.z,
                                  static_cast<float>(source.object_id[i]),
                                  gradient.x,
                                  gradient.y,
                                  source.solid_back[i],
                                  dielectric_f0_at(source, i),
                                  emission.x,
                                  emission.y,
                                  emission.z,
                                  diffuse_share_at(source, i)})
            image.values.push_back(value);
        if (!moved) continue;
        image.values.push_back(source.motion_px[i].x);
        image.values.push_back(source.motion_px[i].y);
    }
    return image;
}

} // namespace ssrlab
