#include "core/error.h"
#include "core/parallel_rows.h"
#include "scene/load_scene.h"
#include "scene/recipe.h"
#include "scene/shapes.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <map>
#include <numbers>

namespace ssrlab {
namespace {

constexpr int teapot_patch_steps = 16;

Mesh make_shape(const Part& part)
{
    const glm::dvec3 half = 0.5 * part.size_m;
    switch (*part.shape) {
    case Shape::box: return make_box(-half, half);
    case Shape::plane:
    case Shape::checker_floor: return make_quad({-half.x, 0, half.z}, {2 * half.x, 0, 0}, {0, 0, -2 * half.z});
    case Shape::sphere: {
        Mesh mesh = make_sphere({0, 0, 0}, 0.5, 96, 48);
        transform(mesh, glm::scale(glm::dmat4(1), part.size_m));
        return mesh;
    }
    case Shape::cylinder: {
        Mesh mesh = make_cylinder({0, 0, 0}, 0.5, 1, 64);
        transform(mesh, glm::scale(glm::dmat4(1), part.size_m));
        return mesh;
    }
    case Shape::teapot: return make_teapot(teapot_patch_steps);
    }
    return {};
}

void add_pattern(Model& model, Mesh& mesh, const Part& part)
{
    PatternTextures textures = make_pattern(*part.pattern);
    model.textures.push_back(std::move(textures.base_colour));
    model.textures.push_back(std::move(textures.gloss));
    Material& material   = model.materials[0];
    material.base_colour = glm::vec4(1);
    material.metallic = material.roughness      = 1;
    material.base_colour_texture.texture        = 0;
    material.metallic_roughness_texture.texture = 1;
    multiply_uv(mesh, 1 / part.tile_m);
}

Model shape_to_model(const Part& part)
{
    Model model;
    Mesh  mesh = make_shape(part);
    mesh.name  = part.name;
    model.materials.push_back(make_material(part.name, glm::vec3(0.7F), 0, 0.8F));
    if (part.pattern) {
        add_pattern(model, mesh, part);
    } else if (part.shape == Shape::checker_floor || !part.tile_colours.empty()) {
        const glm::vec3 light = part.tile_colours.empty() ? glm::vec3(0.8F) : glm::vec3(part.tile_colours[0]);
        const glm::vec3 dark  = part.tile_colours.empty() ? glm::vec3(0.35F) : glm::vec3(part.tile_colours[1]);
        model.textures.push_back(make_checker_texture(light, dark));
        model.materials[0].base_colour                 = glm::vec4(1);
        model.materials[0].base_colour_texture.texture = 0;
        multiply_uv(mesh, 0.5 / part.tile_m); // a repeat is two tiles wide
    } else if (part.ripple_m) {
        model.textures.push_back(make_wave_normals());
        model.materials[0].normal_texture.texture = 0;
        model.materials[0].normal_scale           = static_cast<float>(part.ripple_slope);
        multiply_uv(mesh, 1 / *part.ripple_m);
    }
    model.meshes.push_back(std::move(mesh));
    return model;
}

/// The data that a recipe names at `place`.
std::filesystem::path find_named(const std::string& name, const std::filesystem::path& folder, const std::string& place)
{
    try {
        return find_data(name, folder);
    } catch (const SpecError& error) {
        throw_spec_error("{}: {}", place, error.what());
    }
}

Model file_to_model(const Part& part, const std::filesystem::path& folder)
{
    const std::filesystem::path file      = find_named(part.file, folder, part.place);
    const std::string           extension = lower_extension(file);
    Model model = extension == ".glb" || extension == ".gltf" ? load_gltf(file) : import_model(file);
    model.lights.clear(); // a recipe names its own
    model.cameras.clear();
    model.paths.clear();
    return model;
}

/// The models of the parts: one that is used twice is read once, and several at a time.
std::map<std::string, Model> read_files(const Recipe& recipe, const std::filesystem::path& folder)
{
    std::map<std::string, Model> models;
    std::vector<const Part*>     first; // that names the file
    for (const Part& part : recipe.parts)
        if (!part.shape && models.try_emplace(part.file).second) first.push_back(&part);
    parallel_rows(int(first.size()), 0, [&](int i) {
        const Part& part     = *first[size_t(i)];
        models.at(part.file) = file_to_model(part, folder);
    });
    return models;
}

glm::dmat4 rotation_of(const Part& part)
{
    const glm::dvec3 rad = part.rotation_deg * (std::numbers::pi / 180);
    glm::dmat4       rotation(1);
    rotation = glm::rotate(rotation, rad.z, {0, 0, 1});
    rotation = glm::rotate(rotation, rad.y, {0, 1, 0});
    rotation = glm::rotate(rotation, rad.x, {1, 0, 0});
    return part.z_up ? glm::rotate(rotation, -std::numbers::pi / 2, {1, 0, 0}) : rotation;
}

/// Turns and scales the part, and puts the middle of its bottom at the origin.
void normalize_placement(Model& model, const Part& part)
{
    const glm::dmat4 rotation = rotation_of(part);
    const Bounds     bounds   = bounds_of(model, rotation);
    if (bounds.empty()) throw_failure("{}: part '{}' has no usable triangle", part.place, part.name);
    const double scale = part.height_m ? *part.height_m / bounds.size_m().y : part.unit_m;
    if (!std::isfinite(scale))
        throw_spec_error("{}: part '{}' is flat: 'height_m' cannot be used", part.place, part.name);
    const glm::dvec3 bottom(bounds.centre_ws().x, bounds.min_ws.y, bounds.centre_ws().z);
    const glm::dmat4 scaling = glm::scale(glm::dmat4(1), glm::dvec3(scale));
    transform(model, scaling * glm::translate(glm::dmat4(1), -bottom) * rotation);
}

void apply(const MaterialChange& change, Material& material)
{
    const bool dropped = change.drop_textures;
    if (dropped) material.base_colour_texture = material.normal_texture = material.emissive_texture = {};
    // A texture multiplies the factor: a value given by hand must not be multiplied.
    if (dropped || change.metallic || change.roughness) material.metallic_roughness_texture = {};
    if (change.metallic) material.metallic = static_cast<float>(*change.metallic);
    if (change.roughness) material.roughness = static_cast<float>(*change.roughness);
    if (change.ior) material.dielectric_f0 = ior_to_f0(*change.ior);
    if (change.base_colour) material.base_colour = {glm::vec3(*change.base_colour), material.base_colour.a};
    if (change.emissive) material.emissive = *change.emissive;
    if (change.double_sided) material.double_sided = *change.double_sided;
}

/// Returns whether anything matched.
bool apply(const MaterialChange& change, const Part& part, Model& model)
{
    if (!matches(change.part, part.name)) return false;
    bool any = false;
    for (size_t i = 0; i < model.materials.size(); ++i) {
        if (!matches(change.name, model.materials[i].name)) continue;
        any = true;
        apply(change, model.materials[i]);
        if (change.leave_out) std::erase_if(model.meshes, [&](const Mesh& mesh) { return mesh.material == i; });
    }
    return any;
}

void refuse_unmatched(const Recipe& recipe, const std::vector<bool>& matched, const Model& model)
{
    for (size_t i = 0; i < matched.size(); ++i) {
        if (matched[i]) continue;
        std::string names;
        for (const Material& material : model.materials) names += (names.empty() ? "" : ", ") + material.name;
        throw_spec_error("{}: [[material]]: name '{}', part '{}' matches nothing; the materials are: {}",
                         recipe.changes[i].place, recipe.changes[i].name, recipe.changes[i].part, names);
    }
}

} // namespace

Model load_recipe(const std::filesystem::path& file)
{
    const Recipe                       recipe = read_recipe(file);
    const std::map<std::string, Model> files  = read_files(recipe, file.parent_path());
    std::vector<bool>                  matched(recipe.changes.size(), false);
    Model                              scene;
    for (const Part& part : recipe.parts) {
        Model model = part.shape ? shape_to_model(part) : files.at(part.file);
        normalize_placement(model, part);
        apply(part.change, part, model);
        for (size_t i = 0; i < recipe.changes.size(); ++i)
            if (apply(recipe.changes[i], part, model)) matched[i] = true;
        for (Mesh& mesh : model.meshes) mesh.name = fmt::format("{}/{}", part.name, mesh.name);
        const bool moves = part.motion != RigidMotion{};
        if (moves &&
            std::ranges::any_of(model.meshes, [](const Mesh& mesh) { return mesh.motion.poses || mesh.skin.joints; }))
            throw_spec_error("{}: part '{}' has 'move_m' or 'turn_deg', but its file moves by itself", part.place,
                             part.name);
        for (const glm::dvec3& position_ws : part.positions_ws) {
            Model copy = model;
            transform(copy, glm::translate(glm::dmat4(1), position_ws));
            for (Mesh& mesh : copy.meshes) {
                if (moves) mesh.motion = part.motion;
                mesh.motion.pivot_ws = position_ws;
            }
            append(scene, std::move(copy));
        }
    }
    refuse_unmatched(recipe, matched, scene);
    scene.lights     = recipe.lights;
    scene.cameras    = recipe.views;
    scene.paths      = recipe.paths;
    scene.ambient    = recipe.ambient;
    scene.background = recipe.background;
    scene.bake       = recipe.bake;
    if (!recipe.environment.empty())
        scene.environment =
            load_environment(find_named(recipe.environment, file.parent_path(), recipe.environment_place),
                             recipe.environment_scale, scene.warnings);
    if (recipe.sky) scene.environment = make_sky(*recipe.sky);
    return scene;
}

} // namespace ssrlab
