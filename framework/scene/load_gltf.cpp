#include "scene/gltf.h"
#include "scene/load_scene.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace ssrlab {
namespace gltf {
namespace {

struct Visit {
    int        node  = 0;
    int        depth = 0;
    glm::dmat4 to_world{1};
    Poses      moving  = {};   // node to world in each frame, if it or a node above it is animated
    bool       visible = true; // KHR_node_visibility, of the nodes above
};

/// A camera's far plane (glTF 2.0, 3.10.3).
struct FarPlane {
    std::string name;
    glm::dvec3  position_ws, axis_ws;
    double      distance_m = 0;
};

Camera camera_at(const tinygltf::Camera& source, const std::string& node_name, const glm::dmat4& to_world)
{
    Camera camera;
    camera.name        = !source.name.empty() ? source.name : node_name;
    camera.position_ws = glm::dvec3(to_world[3]);
    camera.target_ws   = camera.position_ws - glm::normalize(glm::dvec3(to_world[2]));
    camera.up_ws       = glm::normalize(glm::dvec3(to_world[1]));
    if (source.type == "orthographic") {
        camera.projection = Projection::orthographic;
        camera.height_m   = 2 * std::abs(source.orthographic.ymag);
        camera.near_m     = std::max(source.orthographic.znear, 1e-3);
        camera.far_m      = source.orthographic.zfar;
    } else {
        camera.fov_y_deg = source.perspective.yfov * 180 / std::numbers::pi;
        camera.near_m    = source.perspective.znear;
    }
    return camera;
}

void add_camera(Import& import, std::vector<FarPlane>& far_planes, int camera_index, const std::string& node_name,
                const Visit& at)
{
    if (static_cast<size_t>(camera_index) >= import.json.cameras.size())
        import.fail("there is no camera {}", camera_index);
    const tinygltf::Camera& source = import.json.cameras[static_cast<size_t>(camera_index)];
    try {
        const Camera camera = camera_at(source, node_name, at.to_world);
        camera_to_view(camera, camera.size_px);
        import.model.cameras.push_back(camera);
        if (camera.projection == Projection::perspective && source.perspective.zfar > camera.near_m)
            far_planes.push_back(
                {camera.name, camera.position_ws, camera.target_ws - camera.position_ws, source.perspective.zfar});
        if (!at.moving) return;
        CameraPath path{camera.name, {}, 1};
        for (const glm::dmat4& to_world : *at.moving) {
            path.cameras.push_back(camera_at(source, node_name, to_world));
            camera_to_view(path.cameras.back(), camera.size_px);
        }
        import.model.paths.push_back(std::move(path));
    } catch (const SpecError& error) {
        import.warn(fmt::format("camera {} left out: {}", camera_index, error.what()));
    }
}

void add_light(Import& import, int light_index, const glm::dmat4& to_world, bool moves)
{
    if (moves) import.warn("animated lights are not supported: they stay where they are in frame 0");
    if (light_index < 0 || static_cast<size_t>(light_index) >= import.json.lights.size())
        import.fail("there is no light {}", light_index);
    const tinygltf::Light& source = import.json.lights[static_cast<size_t>(light_index)];
    ModelLight             light;
    if (source.type == "point")
        light.light.type = LightType::point;
    else if (source.type == "spot")
        light.light.type = LightType::spot;
    else if (source.type != "directional")
        import.fail("/extensions/KHR_lights_punctual/lights/{}: unknown type '{}'", light_index, source.type);
    for (int c = 0; c < 3; ++c) {
        const double colour      = source.color.size() == 3 ? source.color[static_cast<size_t>(c)] : 1;
        light.light.intensity[c] = static_cast<float>(std::clamp(colour * source.intensity, 0.0, 1e9));
    }
    const double outer_rad      = std::clamp(source.spot.outerConeAngle, 1e-3, std::numbers::pi / 2);
    light.light.range_m         = static_cast<float>(std::max(source.range, 0.0));
    light.light.outer_angle_rad = static_cast<float>(outer_rad);
    light.light.inner_angle_rad = static_cast<float>(std::clamp(source.spot.innerConeAngle, 0.0, outer_rad));
    light.position_ws           = glm::dvec3(to_world[3]);
    const glm::dvec3 direction  = -glm::dvec3(to_world[2]);
    if (glm::length(direction) > 0) light.light.direction_ws = glm::vec3(glm::normalize(direction));
    import.model.lights.push_back(light);
}

/// The nodes that the default scene starts from; without scenes, those that are nobody's children.
std::vector<int> root_nodes(const Import& import)
{
    const auto& json = import.json;
    if (!json.scenes.empty()) {
        const int scene = json.defaultScene >= 0 ? json.defaultScene : 0;
        if (static_cast<size_t>(scene) >= json.scenes.size()) import.fail("/scene: there is no scene {}", scene);
        return json.scenes[static_cast<size_t>(scene)].nodes;
    }
    std::vector<bool> is_child(json.nodes.size(), false);
    for (const tinygltf::Node& node : json.nodes)
        for (int child : node.children)
            if (child >= 0 && static_cast<size_t>(child) < is_child.size()) is_child[static_cast<size_t>(child)] = true;
    std::vector<int> roots;
    for (size_t i = 0; i < is_child.size(); ++i)
        if (!is_child[i]) roots.push_back(static_cast<int>(i));
    return roots;
}

struct Walk {
    using Shape = std::pair<int, std::vector<float>>; // a mesh with the weights of its morph targets
    bool                               views_only = false;
    std::vector<Visit>                 pending;
    std::map<Shape, std::vector<Mesh>> meshes; // read once, placed as often as nodes ask
    std::vector<bool>                  material_left_out;
    std::vector<FarPlane>              far_planes;
    size_t                             visits = 0;
};

/// Depth buffers here have no far plane (core/view.h): what lies beyond one is drawn.
void warn_of_far_planes(Import& import, const std::vector<FarPlane>& far_planes)
{
    Bounds bounds;
    for (const Mesh& mesh : import.model.meshes)
        for (const glm::dvec3& position_ws : mesh.positions_ws) bounds.add(position_ws);
    if (bounds.empty()) return;
    for (const FarPlane& plane : far_planes) {
        const glm::dvec3 farthest_ws =
            glm::mix(bounds.min_ws, bounds.max_ws, glm::greaterThan(plane.axis_ws, glm::dvec3(0)));
        const double farthest_m = glm::dot(farthest_ws - plane.position_ws, plane.axis_ws);
        if (farthest_m > plane.distance_m)
            import.warn(fmt::format("camera '{}': zfar ({:g} m) is not supported: what lies beyond it, up to {:.3g} m "
                                    "away, is drawn",
                                    plane.name, plane.distance_m, farthest_m));
    }
}

bool is_rigid(const glm::dmat4& matrix)
{
    constexpr double rounding = 1e-4; // of floats in files, multiplied down the hierarchy
    const glm::dmat3 linear(matrix), product = glm::transpose(linear) * linear;
    for (int c : {0, 1, 2})
        for (int r : {0, 1, 2})
            if (!(std::abs(product[c][r] - (c == r ? 1 : 0)) < rounding)) return false;
    return glm::determinant(linear) > 0;
}

/// What a node's meshes do from frame 0 on. Null where it is not rigid, or nothing.
Poses rigid_poses(Import& import, const Visit& at)
{
    if (!at.moving) return nullptr;
    const glm::dmat4 back  = glm::inverse(at.to_world);
    auto             poses = std::make_shared<std::vector<glm::dmat4>>();
    bool             still = true;
    for (const glm::dmat4& to_world : *at.moving) {
        still = still && to_world == at.to_world;
        poses->push_back(poses->empty() ? glm::dmat4(1) : to_world * back);
        if (is_rigid(poses->back())) continue;
        import.warn(fmt::format("node {}: its animation scales or shears, which is not supported: drawn as in frame 0",
                                at.node));
        return nullptr;
    }
    return still ? nullptr : poses;
}

/// A copy of each of its parts with the morph targets of that node, counted.
std::vector<Mesh> parts_of(Import& import, Walk& walk, int node)
{
    const int mesh_index = import.json.nodes[size_t(node)].mesh;
    if (static_cast<size_t>(mesh_index) >= import.json.meshes.size()) import.fail("there is no mesh {}", mesh_index);
    const Walk::Shape shape{mesh_index, morph_weights(import, node)};
    if (!walk.meshes.contains(shape))
        walk.meshes.emplace(shape, read_mesh(import, mesh_index, shape.second, walk.material_left_out));
    for (const Mesh& mesh : walk.meshes.at(shape)) import.triangles += mesh.indices.size() / 3;
    if (import.triangles > max_triangles) refuse_triangles(import, import.triangles);
    return walk.meshes.at(shape);
}

/// A mesh with a skin is where its joints take it, whatever the node's own matrix (glTF 2.0, 3.7.3.3).
void place_mesh(Import& import, Walk& walk, const Visit& at, const glm::dmat4& to_world, const JointPoses& joints,
                const Poses& poses)
{
    for (Mesh& mesh : parts_of(import, walk, at.node)) {
        if (joints && !mesh.skin.vertices.empty()) {
            check_joints(import, mesh, joints->front().size());
            bend(mesh, joints);
        } else {
            transform(mesh, to_world);
            mesh.motion.poses = poses;
            mesh.skin         = {};
        }
        import.model.meshes.push_back(std::move(mesh));
    }
}

/// Whether each part of the node's mesh says which joints move it.
bool follows_joints(const Import& import, int node)
{
    const int mesh = import.json.nodes[size_t(node)].mesh;
    return mesh < static_cast<int>(import.json.meshes.size()) &&
           std::ranges::all_of(import.json.meshes[size_t(mesh)].primitives, [](const tinygltf::Primitive& primitive) {
               return attribute(primitive, "JOINTS_0") >= 0 && attribute(primitive, "WEIGHTS_0") >= 0;
           });
}

/// All instances of the node's mesh.
void place_meshes(Import& import, Walk& walk, const Visit& inside)
{
    const int                     skin      = import.json.nodes[size_t(inside.node)].skin;
    const std::vector<glm::dmat4> instances = instances_of(import, inside.node);
    if (skin < 0) {
        const Poses poses = rigid_poses(import, inside);
        for (const glm::dmat4& instance : instances)
            place_mesh(import, walk, inside, inside.to_world * instance, nullptr, poses);
        return;
    }
    if (instances.size() != 1) import.warn("instances of a mesh with a skin are not supported: it is drawn once");
    const bool all_follow = follows_joints(import, inside.node);
    place_mesh(import, walk, inside, inside.to_world, joint_poses(import, skin),
               all_follow ? nullptr : rigid_poses(import, inside));
}

/// To be visited in this order, before all that is pending: each as `next`, which names none yet.
void put_first(Walk& walk, std::vector<int> nodes, Visit next)
{
    std::ranges::reverse(nodes);
    for (const int node : nodes) {
        next.node = node;
        walk.pending.push_back(next);
    }
}

/// The same visit in the node's own space, in every frame if anything moves it.
Visit entered(Import& import, const Visit& at)
{
    Visit inside    = at;
    inside.to_world = at.to_world * local_matrix(import, at.node, 0);
    if (!at.moving && !import.tracks.contains(at.node)) return inside;
    import.poses += static_cast<size_t>(import.frames);
    if (import.poses > max_poses)
        import.fail("animations: more than {} poses: {} frames at {} frames a second, of too many nodes", max_poses,
                    import.frames, gltf_frames_per_second);
    auto moving = std::make_shared<std::vector<glm::dmat4>>();
    for (int frame = 0; frame < import.frames; ++frame)
        moving->push_back((at.moving ? (*at.moving)[static_cast<size_t>(frame)] : at.to_world) *
                          local_matrix(import, at.node, frame));
    inside.moving = moving;
    return inside;
}

void visit(Import& import, Walk& walk, const Visit& at)
{
    if (at.node < 0 || static_cast<size_t>(at.node) >= import.json.nodes.size())
        import.fail("there is no node {}", at.node);
    if (at.depth > max_node_depth)
        import.fail("/nodes/{}: nodes contain each other, or are nested deeper than {} levels", at.node,
                    max_node_depth);
    if (++walk.visits > max_node_visits) import.fail("more than {} nodes with all instances", max_node_visits);
    const tinygltf::Node& node     = import.json.nodes[static_cast<size_t>(at.node)];
    Visit                 inside   = entered(import, at);
    const glm::dmat4&     to_world = inside.to_world;
    inside.visible                 = at.visible && !is_hidden(node);
    if (node.mesh >= 0 && inside.visible && !walk.views_only) place_meshes(import, walk, inside);
    if (node.camera >= 0) add_camera(import, walk.far_planes, node.camera, node.name, inside); // hidden or not
    const tinygltf::Value* light = extension_of(node, "KHR_lights_punctual");
    if (light != nullptr && light->Has("light") && inside.visible)
        add_light(import, light->Get("light").GetNumberAsInt(), to_world, inside.moving != nullptr);
    put_first(walk, node.children, {-1, at.depth + 1, to_world, inside.moving, inside.visible});
}

Model load(const std::filesystem::path& file, bool views_only)
{
    Import import;
    parse_file(import, file);
    if (!views_only && import.json.meshes.empty()) import.fail("no triangle that can be drawn");
    read_animations(import);
    Walk walk;
    walk.views_only = views_only;
    if (!views_only) walk.material_left_out = add_materials(import);
    put_first(walk, root_nodes(import), {});
    while (!walk.pending.empty()) {
        const Visit next = walk.pending.back();
        walk.pending.pop_back();
        visit(import, walk, next);
    }
    warn_of_far_planes(import, walk.far_planes);
    return std::move(import.model);
}

} // namespace
} // namespace gltf

Model load_gltf(const std::filesystem::path& file) { return gltf::load(file, false); }
Model load_gltf_views(const std::filesystem::path& file) { return gltf::load(file, true); }

} // namespace ssrlab
