#include "sources/cube_rays.h"

#include "core/pixel_index.h"

#include <algorithm>
#include <cmath>

namespace ssrlab {
namespace {

constexpr int   most_faces_a_ray    = 4;
constexpr float depth_of_near_plane = 1;

/// The face that shows a point of a ray.
int face_of(const View& centre, const OpenRay& ray)
{
    // A little farther on, so that a point on the border between two faces lies in the one that the ray enters.
    const double     on_m = ray.clear_m + 1e-6 * (ray.eye_m + ray.clear_m);
    const glm::dvec3 at   = glm::dvec3(centre.world_to_view * glm::dvec4(ray.origin_ws + on_m * ray.direction_ws, 1));
    return face_toward(at);
}

struct Lists {
    std::vector<OpenRay> rays;
    std::vector<size_t>  places; // of each in the list that was asked about

    void add(const OpenRay& ray, size_t place)
    {
        rays.push_back(ray);
        places.push_back(place);
    }
};

} // namespace

View moved_to(const View& view, glm::dvec3 eye_ws)
{
    View moved             = view;
    moved.world_to_view[3] = glm::dvec4(glm::dmat3(view.world_to_view) * -eye_ws, 1);
    return moved;
}

int face_toward(glm::dvec3 point_vs)
{
    const glm::dvec3 size = glm::abs(point_vs);
    const int        axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    return 2 * axis + (point_vs[axis] > 0 ? 0 : 1);
}

void draw_face(SourceContext& context, CubeOfFrames& cube, int number, SourceTurn& turn)
{
    GBufferPtr& face = cube.faces[static_cast<size_t>(number)];
    if (face) return;
    const View       view = face_view(cube.centre, number, cube.size_px);
    const DrawnSides drawn =
        draw_sides_behind(context.stage.gpu, context.stage.uploaded, view,
                          std::vector(pixel_count(view.size_px), depth_of_near_plane), cube.pipeline);
    face = drawn.gbuffer;
    turn.draw_ms += drawn.ms;
    turn.megabytes += megabytes_of(*face);
    cube.images[static_cast<size_t>(number)] = read_gbuffer(context.stage.gpu, *face);
}

View face_view(const View& centre, int face, int size_px)
{
    constexpr std::array<glm::dvec3, 6> forward = {
        {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};
    const glm::dvec3 back  = -forward[static_cast<size_t>(face)];
    const glm::dvec3 up    = std::abs(back.y) > 0.5 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
    const glm::dvec3 right = glm::cross(up, back);
    View             view  = centre;
    view.projection        = Projection::perspective;
    view.size_px           = glm::ivec2(size_px);
    view.focal_px          = glm::dvec2(size_px / 2.0);
    view.centre_px         = glm::dvec2(size_px / 2.0);
    view.world_to_view     = glm::dmat4(glm::transpose(glm::dmat3(right, up, back))) * centre.world_to_view;
    return view;
}

std::vector<RayAnswer> trace_in_cube(SourceContext& context, CubeOfFrames& cube, const TraceSettings& settings,
                                     RayStart start, std::span<const OpenRay> rays, SourceTurn& turn)
{
    std::vector<RayAnswer> answers;
    Lists                  left;
    for (const OpenRay& ray : rays) {
        left.add(ray, answers.size());
        answers.push_back({.kind = AnswerKind::open, .clear_m = ray.clear_m});
    }
    for (int round = 0; round < most_faces_a_ray && !left.rays.empty(); ++round) {
        std::array<Lists, 6> own;
        for (size_t k = 0; k < left.rays.size(); ++k)
            own[static_cast<size_t>(face_of(cube.centre, left.rays[k]))].add(left.rays[k], left.places[k]);
        left = {};
        for (int number = 0; number < 6; ++number) {
            Lists& entering = own[static_cast<size_t>(number)];
            if (entering.rays.empty()) continue;
            draw_face(context, cube, number, turn);
            const GBufferTrace trace =
                trace_in_gbuffer(context, cube.faces[static_cast<size_t>(number)],
                                 cube.images[static_cast<size_t>(number)], settings, start, entering.rays);
            turn.trace_ms += trace.ms;
            for (size_t k = 0; k < entering.rays.size(); ++k) {
                answers[entering.places[k]] = trace.answers[k];
                if (trace.status[k] != TraceStatus::left_screen) continue;
                entering.rays[k].clear_m = trace.left_at_m[k];
                left.add(entering.rays[k], entering.places[k]);
            }
        }
    }
    // What such a camera did not see of a ray is not known to be empty.
    const bool stays = stays_in_sight(context, settings);
    for (size_t k = 0; k < rays.size(); ++k)
        if (!stays || !begins_in_sight(context, start, rays[k])) answers[k].clear_m = rays[k].clear_m;
    return answers;
}

} // namespace ssrlab
