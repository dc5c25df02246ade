// Parts of the glTF loader. Everything is checked before it is used.
#pragma once

#include "core/error.h"
#include "scene/model.h"

#include <tiny_gltf.h>

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace ssrlab::gltf {

/// Limits; a file beyond them is refused.
inline constexpr uint64_t max_file_bytes  = 2ULL << 30;
inline constexpr size_t   max_objects     = 1'000'000; // of each kind: nodes, accessors, ...
inline constexpr int      max_json_depth  = 128;
inline constexpr int      max_node_depth  = 256;
inline constexpr size_t   max_node_visits = 1'000'000;
inline constexpr size_t   max_triangles = 40'000'000; // with all truths 500 bytes each (tests/stress/run sizes): 20 GiB
inline constexpr size_t   max_accessor_rows = 300'000'000;
inline constexpr size_t   max_poses         = 4'000'000; // baked for animations, 128 bytes each

inline constexpr double gltf_frames_per_second = 30; // animations are in seconds, sequences in frames

enum class Interpolation { step, linear, cubic };

/// Keys of one property of a node.
struct Track {
    Interpolation      interpolation = Interpolation::linear;
    int                components    = 3; // 4: a quaternion x, y, z, w
    std::vector<float> times_s;           // increasing
    std::vector<float> values;            // a row for each time; cubic: arriving tangent, value, leaving tangent
};

struct NodeTracks {
    std::optional<Track> translation, rotation, scale;
};

struct Import {
    std::string                       file; // for messages
    tinygltf::Model                   json;
    Model                             model;
    size_t                            triangles = 0;
    std::map<int, NodeTracks>         tracks;        // by node, of those that are animated
    std::map<int, std::vector<float>> first_weights; // by node, of those whose morph targets are animated: in frame 0
    int                               frames = 1;    // until nothing moves any more
    size_t                            poses  = 0;    // that were baked
    std::set<std::string>             said;          // warnings are said once

    void                                          warn(const std::string& text);
    template <typename... Args> [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const;
};

[[noreturn]] void refuse_triangles(const Import& import, uint64_t triangles);

/// Reads and parses the file. Refuses what the parser itself would accept wrongly or crash on.
void parse_file(Import& import, const std::filesystem::path& file);

/// Returns the files of its buffers and images. Throws Failure if the JSON is broken or a URI leads elsewhere.
std::vector<std::filesystem::path> files_named_by(const std::filesystem::path& file);

/// The file's folder joined with a relative URI; throws Failure for absolute paths, schemes, and ways out of the
/// folder.
std::filesystem::path resolve_uri(const std::filesystem::path& folder, const std::string& uri);

/// Returns an accessor as rows of `components` floats (normalised integers become -1..1 or 0..1). Checks bounds.
std::vector<float>    read_floats(const Import& import, int accessor, int components, const std::string& where);
std::vector<uint32_t> read_indices(const Import& import, int accessor, const std::string& where);
int                   component_count(const Import& import, int accessor, const std::string& where);

/// Adds all textures and materials, and one default material at the end. Returns which materials are left out.
std::vector<bool> add_materials(Import& import);

/// KHR_materials_pbrSpecularGlossiness. A surface is as metallic as its reflectance is above a dielectric's.
struct SpecularGlossiness {
    glm::vec4 diffuse{1};  // linear, with alpha
    glm::vec3 specular{1}; // linear
    float     glossiness = 1;
};

/// Sets base colour, metallic, roughness and reflectance by the factors.
void set_factors(Material& material, const SpecularGlossiness& factors);

/// Returns the textures of base colour and of metallic-roughness, with the factors in them; both as large as `gloss`.
/// An empty `diffuse` is white.
std::pair<Texture, Texture> bake(const Texture& diffuse, const Texture& gloss, const SpecularGlossiness& factors);

/// Fills Import::tracks and Import::frames; refuses keys that are not numbers in order.
void read_animations(Import& import);

/// Returns the value at a time. A quaternion between cubic keys is not of unit length.
glm::dvec4 value_at(const Track& track, double time_s);

/// Returns the transform from a node's space to its parent's. Tracks replace the properties that they animate.
glm::dmat4 local_matrix(const Import& import, int node, int frame);

/// Returns the extension of that name; null if the node has none.
const tinygltf::Value* extension_of(const tinygltf::Node& node, const char* name);

/// Returns whether KHR_node_visibility hides the node; that hides the nodes below it, too.
bool is_hidden(const tinygltf::Node& node);

/// Returns where each copy of EXT_mesh_gpu_instancing lies in the node's own space; one at its origin without it.
std::vector<glm::dmat4> instances_of(const Import& import, int node);

/// Returns the transforms from mesh space to world space by a skin's joints: in every frame if they move, else in one.
JointPoses joint_poses(Import& import, int skin);

/// Throws Failure where a vertex follows a joint that the skin does not have.
void check_joints(const Import& import, const Mesh& mesh, size_t joint_count);

/// Poses a mesh as in frame 0; later frames stay in its skin.
void bend(Mesh& mesh, const JointPoses& joints);

/// Returns the accessor of a primitive's attribute; -1 if it has none.
int attribute(const tinygltf::Primitive& primitive, const char* name);

/// Returns the rows of an attribute, none if it is absent. Throws Failure unless there is one for each position.
std::vector<float> rows_of(const Import& import, const tinygltf::Primitive& primitive, const char* name, int components,
                           size_t vertex_count, const std::string& where);

/// Returns the joints that the vertices `used` follow, a row for each; none if the primitive does not name them.
std::vector<Influences> read_influences(Import& import, const tinygltf::Primitive& primitive, size_t vertex_count,
                                        const std::vector<uint32_t>& used, const std::string& where);

/// Returns the weights of the morph targets of the node's mesh in frame 0: those of an animation, else of the node,
/// else of the mesh; empty: none counts.
std::vector<float> morph_weights(const Import& import, int node);

/// Adds the primitive's morph targets, by their weights, to the first `delta_components` of an attribute's rows (glTF
/// 2.0, 3.7.2.2).
void add_morph_targets(const Import& import, const tinygltf::Primitive& primitive, const char* name, int components,
                       int delta_components, const std::vector<float>& weights, std::vector<float>& rows,
                       const std::string& where);

/// Returns a mesh's primitives in the mesh's own space, with their morph targets by these weights. Skips draws that
/// cannot be shown, with a warning.
std::vector<Mesh> read_mesh(Import& import, int mesh, const std::vector<float>& morph_weights,
                            const std::vector<bool>& material_left_out);

template <typename... Args> void Import::fail(fmt::format_string<Args...> format, Args&&... args) const
{
    throw_failure("{}: {}", file, fmt::format(format, std::forward<Args>(args)...));
}

} // namespace ssrlab::gltf
