#include "core/error.h"
#include "scene/mesh_repair.h"
#include "scene/model.h"
#include "scene/subdivision.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace ssrlab {
namespace {

// Every pixel asks every light; what names a hundred thousand views is no list for people.
constexpr size_t max_lights = 1024, max_cameras = 100'000;

/// A camera that sees all of the bounds, from the front, above and to the right.
Camera fit_camera(const Bounds& bounds)
{
    Camera camera;
    if (bounds.empty()) return camera;
    const double     radius_m   = std::max(0.5 * glm::length(bounds.size_m()), 1e-6);
    const double     distance_m = 1.05 * radius_m / std::sin(0.5 * camera.fov_y_deg * std::numbers::pi / 180);
    const glm::dvec3 towards    = glm::normalize(glm::dvec3(0.5, 0.4, 1.0));
    camera.target_ws            = bounds.centre_ws();
    camera.position_ws          = camera.target_ws + distance_m * towards;
    camera.near_m               = 0.01 * distance_m;
    camera.far_m                = 10 * distance_m;
    camera.hard_for             = "fitted to the bounds: the file names no view";
    return camera;
}

ModelLight default_key_light()
{
    ModelLight light;
    light.light.direction_ws = glm::normalize(glm::vec3(-0.4F, -1.0F, -0.6F));
    light.light.intensity    = glm::vec3(2.5F);
    return light;
}

// In near distances: from there on float positions are off by a thousandth of one.
constexpr double far_in_near_distances = 1e4;

bool is_far(const Camera& camera, glm::dvec3 origin_ws)
{
    return glm::length(camera.position_ws - origin_ws) > far_in_near_distances * camera.near_m;
}

/// A float resolves 1e-7 of its value: far from the world's origin that is a visible step, so the origin moves to the scene, or to the first
/// camera where the scene is large.
glm::dvec3 choose_origin_ws(const Bounds& bounds, const std::vector<Camera>& cameras)
{
    if (bounds.empty()) return {0, 0, 0};
    if (glm::length(bounds.centre_ws()) > 16 * 0.5 * glm::length(bounds.size_m())) return bounds.centre_ws();
    const bool far = !cameras.empty() && is_far(cameras[0], glm::dvec3(0));
    return far ? cameras[0].position_ws : glm::dvec3(0);
}

void warn_of_far_cameras(Model& model, glm::dvec3 origin_ws)
{
    for (const Camera& camera : model.cameras)
        if (is_far(camera, origin_ws))
            model.warnings.push_back(fmt::format(
                "view '{}' is {:.3g} m away from the scene's origin: positions there are rounded to {:.2g} m",
                camera.name, glm::length(camera.position_ws - origin_ws),
                glm::length(camera.position_ws - origin_ws) * 0x1p-24));
}

void repair(Model& model)
{
    size_t dropped = 0, turned = 0, no_tangent = 0;
    for (Mesh& mesh : model.meshes) {
        dropped += drop_bad_triangles(mesh);
        if (!mesh.has_normals) make_flat_normals(mesh);
        turned += replace_bad_normals(mesh);
        clean_attributes(mesh);
        const TextureUse& normals = model.materials.at(mesh.material).normal_texture;
        if (normals.texture >= 0) {
            const size_t made = make_tangents(mesh, normals.uv_set, normals.uv_transform);
            if (mesh.has_tangents) no_tangent += made;
        } else {
            for (Vertex& vertex : mesh.vertices)
                vertex.tangent_ws = glm::vec4(0); // there is nothing to turn normals by
        }
    }
    std::erase_if(model.meshes, [](const Mesh& mesh) { return mesh.indices.empty(); });
    if (dropped > 0) model.warnings.push_back(dropped_triangles_text(dropped));
    if (turned > 0)
        model.warnings.push_back(fmt::format(
            "{} corners of triangles have normals without direction: their triangles' own are used", turned));
    if (no_tangent > 0)
        model.warnings.push_back(fmt::format(
            "{} vertices have tangents without direction: those of their texture coordinates are used", no_tangent));
}

void add_draw(Scene& scene, const Mesh& mesh)
{
    if (scene.vertices.size() + mesh.vertices.size() > std::numeric_limits<uint32_t>::max() ||
        scene.indices.size() + mesh.indices.size() > std::numeric_limits<uint32_t>::max())
        throw_failure("{}: more than 2^32 vertices or indices", scene.name);
    Draw draw;
    draw.name        = mesh.name;
    draw.first_index = static_cast<uint32_t>(scene.indices.size());
    draw.index_count = static_cast<uint32_t>(mesh.indices.size());
    draw.material    = mesh.material;
    draw.motion      = mesh.motion;
    draw.motion.pivot_ws -= scene.origin_ws;
    draw.skin = mesh.skin;
    if (scene.origin_ws != glm::dvec3(0)) {
        const glm::dmat4 to_origin = glm::translate(glm::dmat4(1), -scene.origin_ws);
        draw.motion.poses          = transform(draw.motion.poses, to_origin);
        draw.skin.joints           = transform(draw.skin.joints, to_origin);
    }
    const auto first_vertex = static_cast<uint32_t>(scene.vertices.size());
    for (size_t i = 0; i < mesh.vertices.size(); ++i) {
        Vertex vertex      = mesh.vertices[i];
        vertex.position_ws = glm::vec3(mesh.positions_ws[i] - scene.origin_ws);
        draw.bounds_min_ws = glm::min(draw.bounds_min_ws, vertex.position_ws);
        draw.bounds_max_ws = glm::max(draw.bounds_max_ws, vertex.position_ws);
        scene.vertices.push_back(vertex);
    }
    for (uint32_t index : mesh.indices) scene.indices.push_back(first_vertex + index);
    scene.draws.push_back(std::move(draw));
}

void refuse_more_than(size_t most, size_t count, const char* what, const std::string& scene)
{
    if (count > most) throw_spec_error("{}: {} {}, at most {} are supported", scene, count, what, most);
}

} // namespace

void make_camera_names_unique(std::vector<Camera>& cameras)
{
    std::set<std::string>      used;
    std::map<std::string, int> last_number; // of a name: thousands may have the same
    for (Camera& camera : cameras) {
        const std::string base = camera.name.empty() ? "camera" : camera.name;
        int&              last = last_number.try_emplace(base, 1).first->second;
        camera.name            = base;
        while (!used.insert(camera.name).second) camera.name = fmt::format("{}_{}", base, ++last);
    }
}

Scene model_to_scene(Model model, const std::string& name)
{
    refuse_more_than(max_lights, model.lights.size(), "lights", name);
    refuse_more_than(max_cameras, model.cameras.size(), "cameras", name);
    repair(model);
    merge_duplicates(model);
    const Bounds bounds = bounds_of(model);
    if (model.bake) subdivide(model, *model.bake);

    Scene scene;
    scene.name      = name;
    scene.bake      = model.bake;
    scene.origin_ws = choose_origin_ws(bounds, model.cameras);
    warn_of_far_cameras(model, scene.origin_ws);
    for (const Mesh& mesh : model.meshes) add_draw(scene, mesh);
    scene.materials = std::move(model.materials);
    scene.textures  = std::move(model.textures);
    if (model.lights.empty() && !model.bake) model.lights.push_back(default_key_light());
    for (ModelLight& light : model.lights) {
        light.light.position_ws = glm::vec3(light.position_ws - scene.origin_ws);
        scene.lights.push_back(light.light);
    }
    if (model.cameras.empty()) model.cameras.push_back(fit_camera(bounds));
    for (Camera& camera : model.cameras) {
        camera.position_ws -= scene.origin_ws;
        camera.target_ws -= scene.origin_ws;
    }
    for (CameraPath& path : model.paths)
        for (Camera& camera : path.cameras) {
            camera.position_ws -= scene.origin_ws;
            camera.target_ws -= scene.origin_ws;
        }
    scene.paths = std::move(model.paths);
    make_camera_names_unique(model.cameras);
    scene.cameras = std::move(model.cameras);
    if (model.ambient) scene.ambient = *model.ambient;
    if (model.background) scene.background = *model.background;
    scene.environment = std::move(model.environment);
    std::set<std::string> said;
    for (std::string& warning : model.warnings)
        if (said.insert(warning).second) scene.warnings.push_back(std::move(warning));
    return scene;
}

} // namespace ssrlab
