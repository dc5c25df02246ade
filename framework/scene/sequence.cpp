#include "scene/sequence.h"

#include "core/error.h"
#include "scene/skin.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <numbers>

namespace ssrlab {
namespace {

bool is_still(const RigidMotion& motion)
{
    return !motion.poses && motion.move_m == glm::dvec3(0) && motion.turn_deg == glm::dvec3(0);
}

bool is_still(const Draw& draw) { return is_still(draw.motion) && !draw.skin.joints; }

double radical_inverse(int index, int base)
{
    double value = 0, digit = 1.0 / base;
    for (; index > 0; index /= base, digit /= base) value += digit * (index % base);
    return value;
}

/// A draw's vertices are its own: no other draw has indices to them.
void move_draw(Scene& scene, Draw& draw, int frame)
{
    const auto first = scene.indices.begin() + draw.first_index, end = first + draw.index_count;
    const auto [low, high]  = std::minmax_element(first, end);
    const glm::dmat4 matrix = draw.skin.joints ? glm::dmat4(1) : pose(draw.motion, frame);
    const glm::mat3  turn(matrix);
    draw.bounds_min_ws = Draw{}.bounds_min_ws;
    draw.bounds_max_ws = Draw{}.bounds_max_ws;
    for (uint32_t i = *low; i <= *high; ++i) {
        Vertex& vertex = scene.vertices[i];
        if (draw.skin.joints) {
            glm::dvec3 position_ws = vertex.position_ws;
            move_vertex(pose(draw.skin.vertices[i - *low], draw.skin.joints, frame), position_ws, vertex);
            vertex.position_ws = glm::vec3(position_ws);
        } else {
            vertex.position_ws = glm::vec3(matrix * glm::dvec4(vertex.position_ws, 1));
            vertex.normal_ws   = turn * vertex.normal_ws;
            vertex.tangent_ws  = glm::vec4(turn * glm::vec3(vertex.tangent_ws), vertex.tangent_ws.w);
        }
        draw.bounds_min_ws = glm::min(draw.bounds_min_ws, vertex.position_ws);
        draw.bounds_max_ws = glm::max(draw.bounds_max_ws, vertex.position_ws);
    }
}

Camera between(const Camera& a, const Camera& b, double share)
{
    Camera camera      = a;
    camera.position_ws = glm::mix(a.position_ws, b.position_ws, share);
    camera.target_ws   = glm::mix(a.target_ws, b.target_ws, share);
    camera.up_ws       = glm::mix(a.up_ws, b.up_ws, share);
    camera.fov_y_deg   = glm::mix(a.fov_y_deg, b.fov_y_deg, share);
    camera.height_m    = glm::mix(a.height_m, b.height_m, share);
    camera.shift_px    = glm::mix(a.shift_px, b.shift_px, share);
    return camera;
}

/// The path that a view is, or nothing.
const CameraPath* find_path(const Scene& scene, const std::string& view)
{
    auto path = std::ranges::find(scene.paths, view, &CameraPath::name);
    if (path == scene.paths.end())
        path = std::ranges::find(scene.paths, find_camera(scene, view).name, &CameraPath::name);
    return path == scene.paths.end() ? nullptr : &*path;
}

/// From the camera before this one.
int frames_to(const CameraPath& path, size_t camera)
{
    return std::ranges::find(path.cuts, camera) == path.cuts.end() ? path.frames_per_view : 1;
}

/// Whether the view jumps to one of these frames.
bool is_cut_between(const Scene& scene, const std::string& view, int after_frame, int frame)
{
    const CameraPath* path = find_path(scene, view);
    if (path == nullptr) return false;
    int at = 0;
    for (size_t camera = 1; camera < path->cameras.size(); ++camera) {
        at += frames_to(*path, camera);
        const bool is_cut = std::ranges::find(path->cuts, camera) != path->cuts.end();
        if (is_cut && at > after_frame && at <= frame) return true;
    }
    return false;
}

} // namespace

glm::dmat4 pose(const RigidMotion& motion, int frame)
{
    if (motion.poses) return (*motion.poses)[std::min(size_t(frame), motion.poses->size() - 1)];
    const glm::dvec3 rad    = motion.turn_deg * (frame * std::numbers::pi / 180);
    glm::dmat4       matrix = glm::translate(glm::dmat4(1), motion.pivot_ws + double(frame) * motion.move_m);
    matrix                  = glm::rotate(matrix, rad.z, {0, 0, 1});
    matrix                  = glm::rotate(matrix, rad.y, {0, 1, 0});
    matrix                  = glm::rotate(matrix, rad.x, {1, 0, 0});
    return glm::translate(matrix, -motion.pivot_ws);
}

glm::dmat4 current_to_previous(const RigidMotion& motion, int frame, int frames_back)
{
    if (frame < frames_back || is_still(motion)) return glm::dmat4(1);
    return pose(motion, frame - frames_back) * glm::inverse(pose(motion, frame));
}

bool anything_moves(const Scene& scene)
{
    return std::ranges::any_of(scene.draws, [](const Draw& draw) { return !is_still(draw); });
}

Scene scene_at(const Scene& scene, int frame)
{
    Scene moved = scene;
    if (frame == 0) return moved;
    for (Draw& draw : moved.draws)
        if (!is_still(draw) && draw.index_count > 0) move_draw(moved, draw, frame);
    return moved;
}

glm::dvec2 jitter_px(SequenceFrame at)
{
    if (at.jitter_phases == 0) return {0, 0};
    const int index = at.frame % at.jitter_phases + 1;
    return {radical_inverse(index, 2) - 0.5, radical_inverse(index, 3) - 0.5};
}

Camera unjittered_camera_at(const Scene& scene, const std::string& view, int frame)
{
    const CameraPath* path = find_path(scene, view);
    if (path == nullptr) return find_camera(scene, view);
    int    start = 0;
    size_t to    = 1;
    while (to + 1 < path->cameras.size() && frame >= start + frames_to(*path, to)) start += frames_to(*path, to++);
    const double part   = std::min(double(frame - start) / frames_to(*path, to), 1.0);
    Camera       camera = between(path->cameras[to - 1], path->cameras[to], part);
    camera.name         = path->name;
    return camera;
}

Camera camera_at(const Scene& scene, const std::string& view, SequenceFrame at)
{
    Camera camera = unjittered_camera_at(scene, view, at.frame);
    camera.shift_px += jitter_px(at);
    return camera;
}

View view_at(const Scene& scene, const std::string& view, glm::ivec2 size_px, SequenceFrame at)
{
    const Camera camera = camera_at(scene, view, at);
    if (size_px == glm::ivec2(0)) size_px = camera.size_px;
    if (!scene.frame) return camera_to_view(camera, size_px);
    if (size_px != camera.size_px)
        throw_spec_error("scene '{}' is a frame of {}x{} pixels: it cannot be drawn at {}x{}", scene.name,
                         camera.size_px.x, camera.size_px.y, size_px.x, size_px.y);
    if (at != SequenceFrame{})
        throw_spec_error("scene '{}' is one frame of another renderer: it has no further frames and no jitter",
                         scene.name);
    return scene.frame->gbuffer.view;
}

std::optional<FrameMotion> motion_at(const Scene& scene, const std::string& view, glm::ivec2 size_px, int frame,
                                     int frames_back)
{
    const int earlier = frame - frames_back;
    if (earlier < 0 || scene.frame || is_cut_between(scene, view, earlier, frame)) return std::nullopt;
    FrameMotion motion;
    motion.frame         = frame;
    motion.view          = camera_to_view(unjittered_camera_at(scene, view, frame), size_px);
    motion.previous_view = camera_to_view(unjittered_camera_at(scene, view, earlier), size_px);
    const View &now = motion.view, &before = motion.previous_view;
    motion.camera_moves = now.world_to_view != before.world_to_view || now.focal_px != before.focal_px ||
                          now.centre_px != before.centre_px;
    for (const Draw& draw : scene.draws) {
        // No matrix says where each point of what joints bend was.
        motion.to_previous_ws.push_back(draw.skin.joints ? glm::dmat4(std::numeric_limits<double>::quiet_NaN())
                                                         : current_to_previous(draw.motion, frame, frames_back));
        motion.moving_draws += is_still(draw) ? 0 : 1;
    }
    return motion;
}

} // namespace ssrlab
