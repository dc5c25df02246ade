// A scene under construction: separate meshes, positions in double.
//
// Loaders make a Model, recipes place and append Models, model_to_scene() makes the Scene.
#pragma once

#include "scene/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace ssrlab {

struct Mesh {
    std::string             name;
    uint32_t                material = 0; // indexes Model::materials
    std::vector<glm::dvec3> positions_ws;
    std::vector<Vertex>     vertices; // as many as positions_ws; their own position_ws is not used yet
    std::vector<uint32_t>   indices;  // three per triangle, all below positions_ws.size()
    bool                    has_normals  = true;
    bool                    has_tangents = false;
    RigidMotion             motion       = {};
    Skin                    skin         = {}; // bends it from frame 0 on, whose pose the positions have
};

struct ModelLight {
    Light      light;
    glm::dvec3 position_ws{0};
};

struct Model {
    std::vector<Mesh>        meshes;
    std::vector<Material>    materials;
    std::vector<Texture>     textures;
    std::vector<ModelLight>  lights;
    std::vector<Camera>      cameras;
    std::vector<CameraPath>  paths;
    std::optional<glm::vec3> ambient;
    std::optional<glm::vec3> background;
    EnvironmentMap           environment;
    std::optional<Bake>      bake;
    std::vector<std::string> warnings;
};

struct Bounds {
    glm::dvec3 min_ws{std::numeric_limits<double>::infinity()};
    glm::dvec3 max_ws{-std::numeric_limits<double>::infinity()};

    bool       empty() const { return !(min_ws.x <= max_ws.x); }
    glm::dvec3 centre_ws() const { return 0.5 * (min_ws + max_ws); }
    glm::dvec3 size_m() const { return max_ws - min_ws; }
    void       add(glm::dvec3 position_ws);
};

/// Bounds of all usable vertices after `matrix`.
Bounds bounds_of(const Model& model, const glm::dmat4& matrix = glm::dmat4(1));

/// Moves meshes with their poses, lights and cameras; a mirroring matrix flips the winding, so that fronts stay fronts.
void transform(Model& model, const glm::dmat4& matrix);
void transform(Mesh& mesh, const glm::dmat4& matrix);
/// The same motion of a mesh that is moved by `matrix`.
Poses      transform(const Poses& poses, const glm::dmat4& matrix);
JointPoses transform(const JointPoses& joints, const glm::dmat4& matrix);

/// Adds everything of `part` to `model`, with indices moved along.
void append(Model& model, Model part);

void append(Mesh& mesh, const Mesh& part);

/// Materials and textures that are equal become one (parts that appear twice, a wood texture in every cabinet);
/// those that no mesh uses are removed.
void merge_duplicates(Model& model);

/// A position that float can hold with room to spare; anything else is dropped with its triangle.
bool usable(glm::dvec3 position_ws);

/// Numbers cameras of one name.
void make_camera_names_unique(std::vector<Camera>& cameras);

/// Repairs the meshes, adds a camera or light where none is, and moves the origin near to the geometry.
Scene model_to_scene(Model model, const std::string& name);

} // namespace ssrlab
