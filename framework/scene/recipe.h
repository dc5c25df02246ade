// The contents of a recipe before anything is loaded. experiments/scenes/README.md describes the keys.
#pragma once

#include "scene/model.h"
#include "scene/patterns.h"
#include "scene/toml_table.h"

#include <optional>
#include <string>
#include <vector>

namespace ssrlab {

struct MaterialChange {
    std::string               name = "*"; // a pattern with * and ?
    std::string               part = "*";
    std::string               place; // file:line
    std::optional<double>     metallic, roughness, ior;
    std::optional<glm::dvec3> base_colour, emissive;
    bool                      drop_textures = false;
    bool                      leave_out     = false;
    std::optional<bool>       double_sided;
};

enum class Shape : unsigned { box, plane, checker_floor, sphere, cylinder, teapot };

struct Part {
    std::string             name;
    std::string             place;
    std::string             file; // or
    std::optional<Shape>    shape;
    std::vector<glm::dvec3> positions_ws{{0, 0, 0}}; // of the middle of the bottom; the part is repeated at each
    glm::dvec3              rotation_deg{0, 0, 0};   // about x, then y, then z
    bool                    z_up   = false;
    double                  unit_m = 1;      // metres per unit of the file
    std::optional<double>   height_m;        // final height; overrides unit_m
    glm::dvec3              size_m{1, 1, 1}; // shapes only
    RigidMotion             motion;          // pivot_ws: relative to each of the positions
    double                  tile_m = 1;
    std::vector<glm::dvec3> tile_colours; // sRGB
    std::optional<double>   ripple_m;     // a normal map with waves of this length
    double                  ripple_slope = 0.1;
    std::optional<Pattern>  pattern;
    MaterialChange          change;
};

struct Recipe {
    std::string                 file;
    std::string                 summary;
    std::vector<Part>           parts;
    std::vector<MaterialChange> changes;
    std::vector<ModelLight>     lights;
    std::vector<Camera>         views;
    std::vector<CameraPath>     paths;
    std::optional<glm::vec3>    ambient, background;
    std::string                 environment;       // where its picture lies, as find_data() takes it; empty: none
    std::string                 environment_place; // file:line
    std::optional<SkyColours>   sky;               // or this
    std::optional<Bake>         bake;
    double                      environment_scale = 1;
};

Recipe read_recipe(const std::filesystem::path& file);
/// Returns the tables [[view]]. Throws SpecError for two of one name.
std::vector<Camera> read_views(TomlTable& root);

/// * matches any run of characters, ? one; upper and lower case are the same.
bool matches(const std::string& pattern, const std::string& text);

} // namespace ssrlab
