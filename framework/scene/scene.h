// What exists: triangles, materials, lights and cameras, flattened and in metres.
#pragma once

#include "core/gbuffer_image.h"
#include "core/view.h"
#include "scene/environment.h"
#include "scene/load_frame.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace ssrlab {

struct Vertex {
    glm::vec3 position_ws; // metres, relative to Scene::origin_ws
    glm::vec3 normal_ws;   // unit
    glm::vec4 tangent_ws;  // unit, w = handedness; 0 when no texture needs it
    glm::vec2 uv0;
    glm::vec2 uv1;
    glm::vec4 colour;     // linear, 1 when the mesh has none
    glm::vec3 bounced{0}; // radiance that a white diffuse surface would send here by light that Scene::bake asks for
};

/// Light that the CPU computes once, in frame 0 (truth/bounced_light.h), and that vertices keep.
struct Bake {
    double      edge_m  = 0.25; // longer edges are divided
    int         paths   = 256;  // per vertex and bounce
    int         bounces = 4;
    std::string place; // that asks for it, file:line
};

enum class Wrap : uint8_t { repeat, mirrored_repeat, clamp_to_edge };

struct Texture {
    glm::ivec2           size_px{0, 0};
    std::vector<uint8_t> rgba; // row 0 on top
    bool                 srgb    = false;
    bool                 nearest = false; // magnification filter
    bool                 mipmaps = true;
    Wrap                 wrap_u  = Wrap::repeat;
    Wrap                 wrap_v  = Wrap::repeat;
};

/// A texture as a material uses it. `texture` indexes Scene::textures, -1 = none.
struct TextureUse {
    int       texture = -1;
    int       uv_set  = 0;
    glm::mat3 uv_transform{1.0F}; // KHR_texture_transform, applied to (u, v, 1)
};

struct Material {
    std::string name;
    glm::vec4   base_colour{1, 1, 1, 1}; // linear
    float       metallic      = 1;
    float       roughness     = 1;
    float       dielectric_f0 = common_dielectric_f0; // reflectance at normal incidence where it is not metal
    glm::vec3   emissive{0, 0, 0};                    // linear radiance factor
    float       normal_scale = 1;
    bool        double_sided = false;
    bool        alpha_mask   = false; // discard where alpha < alpha_cutoff
    float       alpha_cutoff = 0.5F;
    TextureUse  base_colour_texture, metallic_roughness_texture, normal_texture, emissive_texture;
};

/// From world space in frame 0 to world space in each frame; the last one stays.
using Poses = std::shared_ptr<const std::vector<glm::dmat4>>;

/// A rigid motion: in frame n an object is turned by n * turn_deg about the pivot, then moved by n * move_m. Or,
/// if there are poses, those.
struct RigidMotion {
    glm::dvec3 move_m{0};   // per frame
    glm::dvec3 turn_deg{0}; // per frame, about x, then y, then z
    glm::dvec3 pivot_ws{0}; // in frame 0
    Poses      poses = {};

    bool operator==(const RigidMotion&) const = default;
};

/// What joints a vertex follows; weights add up to 1, or are all 0.
struct Influences {
    std::array<uint32_t, 8> joints{};
    std::array<float, 8>    weights{};
};

/// By frame and joint: from the space in which a skinned mesh is stored to world space. The last frame stays.
using JointPoses = std::shared_ptr<const std::vector<std::vector<glm::dmat4>>>;

/// How joints bend a draw from frame 0 on; of each of its vertices.
struct Skin {
    std::vector<Influences> vertices;
    JointPoses              joints = {}; // null: they stand still
};

/// A camera path: straight from one camera to the next. Or a moving camera, if one has this name.
struct CameraPath {
    std::string         name;
    std::vector<Camera> cameras;              // at least two, of one projection
    int                 frames_per_view = 1;  // from one camera to the next
    std::vector<size_t> cuts            = {}; // of `cameras`: the frame after the camera before it shows this one
};

/// A run of triangles with one material.
struct Draw {
    std::string name;
    uint32_t    first_index = 0;
    uint32_t    index_count = 0;
    uint32_t    material    = 0;
    glm::vec3   bounds_min_ws{std::numeric_limits<float>::infinity()};
    glm::vec3   bounds_max_ws{-std::numeric_limits<float>::infinity()};
    RigidMotion motion;
    Skin        skin = {};
};

enum class LightType : uint8_t { directional, point, spot };

struct Light {
    LightType type = LightType::directional;
    glm::vec3 position_ws{0};         // relative to Scene::origin_ws
    glm::vec3 direction_ws{0, -1, 0}; // unit, from the light into the scene
    glm::vec3 intensity{1}; // linear RGB; lux/pi-free radiometric: irradiance for directional, W/sr for the others
    float     range_m         = 0; // 0 = unlimited
    float     inner_angle_rad = 0;
    float     outer_angle_rad = 0.785398F;
    bool      casts_shadow    = true;
};

struct Scene {
    std::string              name; // as the user named it
    glm::dvec3               origin_ws{0, 0,
                         0}; // subtracted from every position, so that float is enough far from the world's origin
    std::vector<Vertex>      vertices;
    std::vector<uint32_t>    indices; // three per triangle, counter-clockwise = front
    std::vector<Draw>        draws;
    std::vector<Material>    materials;
    std::vector<Texture>     textures;
    std::vector<Light>       lights;
    std::vector<Camera>      cameras;        // at least one; positions relative to origin_ws
    std::vector<CameraPath>  paths;          // scene/sequence.h follows them
    glm::vec3                ambient{0.25F}; // radiance arriving equally from everywhere
    glm::vec3                background{0};  // radiance from infinitely far away, where there is no environment map
    EnvironmentMap           environment;    // what is there instead of `background`, if not empty
    std::optional<Bake>      bake;           // bounced light that its vertices shall have
    std::optional<Frame>     frame;          // of another renderer, instead of triangles, lights and cameras
    std::vector<std::string> warnings;       // one line each: what was dropped or is not supported
};

/// `name`: a .glb/.gltf path, the name of a recipe (experiments/scenes/NAME.toml, or a path to a .toml), builtin:NAME,
/// or an .exr (load_frame.h).
/// Throws SpecError for unknown names and recipe mistakes, Failure for unreadable or damaged files.
Scene load_scene(const std::string& name);

/// Names that load_scene accepts without a path: recipes found on disk and built-ins, with one line of description.
struct SceneListing {
    std::string name;
    std::string summary;
};
std::vector<SceneListing> list_scenes();

/// What to say of a scene's name that load_scene() does not accept.
std::string unknown_scene(const std::string& name);

struct ViewNames {
    std::vector<std::string> cameras, paths; // a path of a camera's name is its motion, and not listed again

    bool has(const std::string& view) const; // "default" is the first camera
};
/// Reads no triangle of a recipe or glTF file.
ViewNames view_names(const std::string& scene);
/// What to say of a name that is none of them.
std::string unknown_view(const std::string& scene, const std::string& view, const ViewNames& names);

/// Returns the radiance from infinitely far away: the environment map, or the background.
glm::vec3 sky_radiance(const Scene& scene, glm::dvec3 direction_ws);

/// The camera of that name; "default" is the first one where none is called so. Throws SpecError listing the names.
const Camera& find_camera(const Scene& scene, const std::string& name);

} // namespace ssrlab
