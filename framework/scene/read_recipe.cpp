#include "core/error.h"
#include "scene/load_scene.h"
#include "scene/recipe.h"

#include <algorithm>
#include <cctype>
#include <numbers>

namespace ssrlab {
namespace {

constexpr double sweethome3d_unit_m = 0.01; // its models are in centimetres

float to_rad(double deg) { return static_cast<float>(deg * std::numbers::pi / 180); }

void read_change_values(TomlTable& table, MaterialChange& change)
{
    change.place         = table.place();
    change.metallic      = table.number("metallic", 0, 1);
    change.roughness     = table.number("roughness", 0, 1);
    change.ior           = table.number("ior", 1, 10);
    change.base_colour   = table.colour("base_colour");
    change.emissive      = table.colour("emissive");
    change.drop_textures = table.flag("drop_textures").value_or(false);
    change.leave_out     = table.flag("leave_out").value_or(false);
    change.double_sided  = table.flag("double_sided");
}

MaterialChange read_change(TomlTable& table)
{
    MaterialChange change;
    change.name = table.text("name").value_or("*");
    change.part = table.text("part").value_or("*");
    read_change_values(table, change);
    table.refuse_unknown_keys();
    return change;
}

void read_shape_keys(TomlTable& table, Part& part)
{
    part.size_m = table.vector("size_m").value_or(part.size_m);
    if (part.size_m.x <= 0 || part.size_m.y < 0 || part.size_m.z <= 0)
        table.fail("size_m", "must be [width, height, depth], greater than 0 (the height of a plane may be 0)");
    if (part.size_m.y == 0 && part.shape != Shape::plane && part.shape != Shape::checker_floor)
        table.fail("size_m", "needs a height greater than 0 for this shape");
    part.tile_m       = table.number("tile_m", 1e-3, 1e6).value_or(part.tile_m);
    part.tile_colours = table.vectors("tile_colours");
    if (!part.tile_colours.empty() && part.tile_colours.size() != 2)
        table.fail("tile_colours", "must be two colours: [[r, g, b], [r, g, b]]");
    part.ripple_m     = table.number("ripple_m", 1e-3, 1e6);
    part.ripple_slope = table.number("ripple_slope", 0, 10).value_or(part.ripple_slope);
    if (part.ripple_m && !part.tile_colours.empty())
        table.fail("ripple_m", "cannot stand beside tile_colours: both say how often textures repeat");
    if (const auto pattern = table.choice("pattern", {"wet_asphalt", "marble", "oak", "brick", "concrete"}))
        part.pattern = static_cast<Pattern>(*pattern);
    if (part.pattern && (part.ripple_m || !part.tile_colours.empty()))
        table.fail("pattern", "cannot stand beside tile_colours or ripple_m: all say how often textures repeat");
}

Part read_part(TomlTable& table)
{
    Part part;
    part.place = table.place();
    part.file  = table.text("file").value_or("");
    if (const auto shape = table.choice("shape", {"box", "plane", "checker_floor", "sphere", "cylinder", "teapot"}))
        part.shape = static_cast<Shape>(*shape);
    if (part.file.empty() == !part.shape.has_value())
        table.fail(part.shape ? "needs either 'file' or 'shape', got both" : "needs either 'file' or 'shape'");
    part.name = table.text("name").value_or(
        part.shape ? *table.text("shape")
                   : std::filesystem::path(part.file.substr(part.file.find(':') + 1)).stem().string());
    if (part.file.starts_with("sweethome3d:")) part.unit_m = sweethome3d_unit_m;
    if (table.has("position")) part.positions_ws = table.vectors("position");
    part.rotation_deg    = table.vector("rotation_deg").value_or(part.rotation_deg);
    part.motion.move_m   = table.vector("move_m").value_or(glm::dvec3(0));
    part.motion.turn_deg = table.vector("turn_deg").value_or(glm::dvec3(0));
    part.z_up            = table.choice("up", {"y", "z"}).value_or(0) == 1;
    part.unit_m          = table.number("unit_m", 1e-9, 1e9).value_or(part.unit_m);
    part.height_m        = table.number("height_m", 1e-6, 1e9);
    if (part.shape) read_shape_keys(table, part);
    if (auto material = table.table("material")) {
        read_change_values(*material, part.change);
        material->refuse_unknown_keys();
    }
    table.refuse_unknown_keys();
    return part;
}

CameraPath read_path(TomlTable& table, const Recipe& recipe)
{
    CameraPath path;
    path.name            = table.text("name").value_or("");
    path.frames_per_view = static_cast<int>(table.number("frames_per_view", 1, 1e6).value_or(30));
    const auto names     = table.texts("views");
    const auto cuts      = table.has("cuts") ? table.texts("cuts") : std::vector<std::string>();
    table.refuse_unknown_keys();
    const auto& views = recipe.views;
    const auto  named = [&](const std::string& name) { return std::ranges::find(views, name, &Camera::name); };
    if (path.name.empty() || named(path.name) != views.end() ||
        std::ranges::find(recipe.paths, path.name, &CameraPath::name) != recipe.paths.end())
        table.fail("needs a 'name' that no other [[path]] and no [[view]] has");
    if (names.size() < 2) table.fail("views", "must name at least two views");
    for (const std::string& name : names) {
        const auto view = named(name);
        if (view == views.end())
            table.fail("views", fmt::format("names '{}', which is no [[view]] of this recipe", name));
        if (!path.cameras.empty() && view->projection != path.cameras.front().projection)
            table.fail("views", "must be all perspective or all orthographic");
        path.cameras.push_back(*view);
    }
    for (const std::string& name : cuts) {
        const auto place = std::ranges::find(names, name);
        if (place == names.begin() || place == names.end() || std::ranges::count(names, name) > 1)
            table.fail("cuts", fmt::format("names '{}', which is not one of the 'views' after the first", name));
        path.cuts.push_back(static_cast<size_t>(place - names.begin()));
    }
    return path;
}

ModelLight read_light(TomlTable& table)
{
    ModelLight light;
    light.light.type = static_cast<LightType>(table.choice("type", {"directional", "point", "spot"}).value_or(0));
    const bool   directional = light.light.type == LightType::directional;
    const auto   position    = table.vector("position");
    const auto   target      = table.vector("target");
    auto         direction   = table.vector("direction");
    const auto   intensity   = table.colour("intensity");
    const double angle_deg   = table.number("angle_deg", 0.1, 170).value_or(80);
    light.light.range_m      = static_cast<float>(table.number("range_m", 0, 1e9).value_or(0));
    light.light.casts_shadow = table.flag("shadow").value_or(true);
    table.refuse_unknown_keys();
    if (!intensity) table.fail("'intensity' is needed: W/m2 for directional, W/sr for spot and point lights");
    if (!directional && !position) table.fail("'position' is needed for spot and point lights");
    if (position && target) direction = *target - *position;
    if (light.light.type != LightType::point && (!direction || glm::length(*direction) == 0))
        table.fail("'direction', or 'position' and 'target', is needed");
    light.position_ws           = position.value_or(glm::dvec3(0));
    light.light.intensity       = *intensity;
    light.light.direction_ws    = direction ? glm::vec3(glm::normalize(*direction)) : light.light.direction_ws;
    light.light.outer_angle_rad = to_rad(0.5 * angle_deg);
    light.light.inner_angle_rad = 0.75F * light.light.outer_angle_rad;
    return light;
}

void read_environment(TomlTable& root, Recipe& recipe)
{
    const auto reference     = root.text("environment");
    const auto scale         = root.number("environment_scale", 0, 1e6);
    recipe.environment_scale = scale.value_or(1);
    if (!reference && scale) root.fail("environment_scale", "needs 'environment', the picture that it scales");
    if (!reference) return;
    const std::string extension = lower_extension(*reference);
    if (extension != ".hdr" && extension != ".exr")
        root.fail("environment", fmt::format("must be an equirectangular .hdr or .exr picture, not '{}'", *reference));
    const std::filesystem::path folder = std::filesystem::path(recipe.file).parent_path();
    if (!reference->starts_with("package:") && !std::filesystem::exists(folder / *reference))
        root.fail("environment",
                  fmt::format("must be a picture that is there, not {}", (folder / *reference).string()));
    recipe.environment       = *reference;
    recipe.environment_place = root.place("environment");
}

void read_sky(TomlTable& root, Recipe& recipe)
{
    auto table = root.table("sky");
    if (!table) return;
    if (!recipe.environment.empty() || recipe.background)
        root.fail("sky", "cannot stand beside environment or background: all say what is there without a surface");
    const auto zenith = table->colour("zenith"), horizon = table->colour("horizon"), ground = table->colour("ground");
    table->refuse_unknown_keys();
    if (!zenith || !horizon) table->fail("needs 'zenith' and 'horizon'");
    recipe.sky = SkyColours{*zenith, *horizon, ground.value_or(*horizon)};
}

std::optional<Bake> read_bake(TomlTable& root)
{
    auto table = root.table("bake");
    if (!table) return std::nullopt;
    Bake bake;
    bake.place   = table->place();
    bake.edge_m  = table->number("edge_m", 1e-3, 1e6).value_or(bake.edge_m);
    bake.paths   = static_cast<int>(table->number("paths", 16, 65536).value_or(bake.paths));
    bake.bounces = static_cast<int>(table->number("bounces", 1, 16).value_or(bake.bounces));
    table->refuse_unknown_keys();
    return bake;
}

} // namespace

bool matches(const std::string& pattern, const std::string& text)
{
    size_t     p         = 0;
    size_t     t         = 0;
    size_t     star      = std::string::npos;
    size_t     star_text = 0;
    const auto lower     = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
    while (t < text.size()) {
        if (p < pattern.size() && pattern[p] == '*') {
            star      = p++;
            star_text = t;
        } else if (p < pattern.size() && (pattern[p] == '?' || lower(pattern[p]) == lower(text[t]))) {
            ++p;
            ++t;
        } else if (star != std::string::npos) {
            p = star + 1;
            t = ++star_text;
        } else {
            return false;
        }
    }
    while (p < pattern.size() && pattern[p] == '*') ++p;
    return p == pattern.size();
}

Recipe read_recipe(const std::filesystem::path& file)
{
    const TomlFile parsed = read_toml(file);
    TomlTable      root(parsed, parsed.root, "recipe");
    Recipe         recipe;
    recipe.file    = file.string();
    recipe.summary = root.text("summary").value_or("");
    if (const auto ambient = root.colour("ambient")) recipe.ambient = glm::vec3(*ambient);
    if (const auto background = root.colour("background")) recipe.background = glm::vec3(*background);
    read_environment(root, recipe);
    read_sky(root, recipe);
    recipe.bake = read_bake(root);
    for (TomlTable& table : root.tables("part")) recipe.parts.push_back(read_part(table));
    for (TomlTable& table : root.tables("material")) recipe.changes.push_back(read_change(table));
    for (TomlTable& table : root.tables("light")) recipe.lights.push_back(read_light(table));
    recipe.views = read_views(root);
    for (TomlTable& table : root.tables("path")) recipe.paths.push_back(read_path(table, recipe));
    root.refuse_unknown_keys();
    if (recipe.parts.empty()) root.fail("needs at least one [[part]]");
    return recipe;
}

std::string recipe_summary(const std::filesystem::path& file)
{
    try {
        return read_toml(file).root["summary"].value_or(std::string());
    } catch (const std::runtime_error&) {
        return {};
    }
}

} // namespace ssrlab
