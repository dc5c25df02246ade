// What renderers fall back to: a cube map from one place, looked up where the ray leaves a box around the scene
// (parallax correction). Nothing is traced: it answers with a colour and not with a point.
#include "core/pixel_index.h"
#include "frame/passes/pass_helpers.h"
#include "frame/scene_pictures.h"
#include "sources/cube_rays.h"
#include "world/grid_walk.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ssrlab {
namespace {

/// The free place nearest to the middle of the scene's bounds that the eye can see; else the eye.
glm::dvec3 place_of_probe(const Occupancy& grid, glm::dvec3 eye_ws)
{
    constexpr int    places_side = 9;
    const glm::dvec3 high_ws     = grid.low_ws + grid.cell_m * glm::dvec3(grid.cells);
    const glm::dvec3 middle_ws   = (grid.low_ws + high_ws) / 2.0;
    glm::dvec3       best_ws     = eye_ws;
    double           best_m      = std::numeric_limits<double>::infinity();
    for (const glm::dvec3& place_ws : free_places(grid, grid.low_ws, high_ws, places_side)) {
        const double away_m = glm::distance(place_ws, middle_ws), to_eye_m = glm::distance(place_ws, eye_ws);
        if (away_m >= best_m || may_meet(grid, place_ws, (eye_ws - place_ws) / to_eye_m, 0, to_eye_m)) continue;
        best_ws = place_ws;
        best_m  = away_m;
    }
    return best_ws;
}

/// How far along a ray the box around the grid ends; 0 where the ray does not go through it.
double leaves_box_m(const Occupancy& grid, const OpenRay& ray)
{
    const glm::dvec3 high_ws = grid.low_ws + grid.cell_m * glm::dvec3(grid.cells);
    double           out_m   = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const double rate = ray.direction_ws[axis];
        if (rate != 0) out_m = std::min(out_m, ((rate > 0 ? high_ws : grid.low_ws)[axis] - ray.origin_ws[axis]) / rate);
    }
    return std::max(out_m, 0.0);
}

glm::vec3 look_up(SourceContext& context, CubeOfFrames& cube, glm::dvec3 at_ws, SourceTurn& turn)
{
    const glm::dvec3 at_vs(cube.centre.world_to_view * glm::dvec4(at_ws, 1));
    const int        number = face_toward(at_vs);
    draw_face(context, cube, number, turn);
    const GBufferImage& face   = cube.images[static_cast<size_t>(number)];
    const glm::dvec3    at_px  = vs_to_px(face.view, glm::dvec3(face.view.world_to_view * glm::dvec4(at_ws, 1)));
    const glm::ivec2    pixel  = glm::clamp(glm::ivec2(glm::floor(glm::dvec2(at_px))), 0, cube.size_px - 1);
    const size_t        i      = pixel_index(pixel, face.view.size_px);
    const glm::dvec3    eye_ws = glm::dvec3(glm::inverse(cube.centre.world_to_view)[3]);
    return face.depth[i] > 0 ? face.radiance[i] + face.highlight[i]
                             : sky_radiance(context.stage.scene, glm::normalize(at_ws - eye_ws));
}

SourceTurn answer(SourceContext& context, std::span<const OpenRay> rays)
{
    const Occupancy& grid   = grid_of(context.stage).grid;
    const glm::dvec3 eye_ws = glm::dvec3(glm::inverse(context.image.view.world_to_view)[3]);
    CubeOfFrames     cube{moved_to(context.image.view, place_of_probe(grid, eye_ws)),
                      static_cast<int>(context.parameters.at("size_px"))};
    SourceTurn       turn;
    for (const OpenRay& ray : rays) {
        RayAnswer& answer = turn.answers.emplace_back(RayAnswer{.kind = AnswerKind::light, .clear_m = ray.clear_m});
        answer.point_ws   = ray.origin_ws + leaves_box_m(grid, ray) * ray.direction_ws;
        answer.light      = look_up(context, cube, answer.point_ws, turn);
    }
    return turn;
}

} // namespace

Source probe_source()
{
    return {.id         = "probe",
            .summary    = "A cube map from the middle of the scene, with parallax correction: a colour, not a point",
            .cite       = {"Lagarde, Zanuttini 2012, Local Image-Based Lighting with Parallax-Corrected Cubemaps"},
            .parameters = {integer_parameter("size_px", 256, 16, 4096, "width and height of a face")},
            .answer     = answer};
}

} // namespace ssrlab
