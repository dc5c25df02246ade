// Skins: joints, inverse bind matrices, and the weights of vertices (glTF 2.0, 3.7.3).
#include "scene/gltf.h"
#include "scene/skin.h"

#include <algorithm>
#include <cmath>

namespace ssrlab::gltf {
namespace {

/// The node above each; -1: none.
std::vector<int> parents_of(const Import& import)
{
    std::vector<int> parents(import.json.nodes.size(), -1);
    for (size_t i = 0; i < parents.size(); ++i)
        for (const int child : import.json.nodes[i].children)
            if (child >= 0 && static_cast<size_t>(child) < parents.size())
                parents[static_cast<size_t>(child)] = static_cast<int>(i);
    return parents;
}

/// The node and all above it.
std::vector<int> path_from(const Import& import, const std::vector<int>& parents, int node)
{
    std::vector<int> path;
    for (; node >= 0; node = parents[static_cast<size_t>(node)]) {
        path.push_back(node);
        if (path.size() > static_cast<size_t>(max_node_depth))
            import.fail("/nodes/{}: nodes contain each other, or are nested deeper than {} levels", node,
                        max_node_depth);
    }
    return path;
}

/// To world space in a frame. `known`: those of nodes that were asked for before.
glm::dmat4 to_world(const Import& import, const std::vector<int>& path, int frame, std::map<int, glm::dmat4>& known)
{
    size_t above = 0;
    while (above < path.size() && !known.contains(path[above])) ++above;
    glm::dmat4 matrix = above < path.size() ? known.at(path[above]) : glm::dmat4(1);
    while (above-- > 0) {
        matrix *= local_matrix(import, path[above], frame);
        known.emplace(path[above], matrix);
    }
    return matrix;
}

std::vector<glm::dmat4> inverse_bind_matrices(const Import& import, const tinygltf::Skin& skin,
                                              const std::string& where)
{
    std::vector<glm::dmat4> matrices(skin.joints.size(), glm::dmat4(1));
    if (skin.inverseBindMatrices < 0) return matrices;
    const std::vector<float> rows = read_floats(import, skin.inverseBindMatrices, 16, where + "/inverseBindMatrices");
    if (rows.size() < 16 * matrices.size())
        import.fail("{}/inverseBindMatrices: {} matrices for {} joints", where, rows.size() / 16, matrices.size());
    for (size_t i = 0; i < matrices.size(); ++i)
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 3; ++row) {
                const float value = rows[16 * i + size_t(4 * column + row)];
                if (!std::isfinite(value)) import.fail("{}/inverseBindMatrices: a value is not finite", where);
                matrices[i][column][row] = double(value);
            }
    return matrices;
}

} // namespace

JointPoses joint_poses(Import& import, int skin_index)
{
    if (static_cast<size_t>(skin_index) >= import.json.skins.size()) import.fail("there is no skin {}", skin_index);
    const tinygltf::Skin&         skin    = import.json.skins[static_cast<size_t>(skin_index)];
    const std::string             where   = fmt::format("/skins/{}", skin_index);
    const std::vector<int>        parents = parents_of(import);
    std::vector<std::vector<int>> paths;
    bool                          moves = false;
    for (const int joint : skin.joints) {
        if (joint < 0 || static_cast<size_t>(joint) >= parents.size())
            import.fail("{}: there is no node {}", where, joint);
        paths.push_back(path_from(import, parents, joint));
        moves = moves || std::ranges::any_of(paths.back(), [&](int node) { return import.tracks.contains(node); });
    }
    const std::vector<glm::dmat4> bind   = inverse_bind_matrices(import, skin, where);
    const int                     frames = moves ? import.frames : 1;
    import.poses += static_cast<size_t>(frames) * paths.size();
    if (import.poses > max_poses)
        import.fail("{}: more than {} poses: {} frames of {} joints", where, max_poses, frames, paths.size());
    auto poses = std::make_shared<std::vector<std::vector<glm::dmat4>>>();
    for (int frame = 0; frame < frames; ++frame) {
        std::vector<glm::dmat4>&  joints = poses->emplace_back();
        std::map<int, glm::dmat4> known;
        for (size_t i = 0; i < paths.size(); ++i) joints.push_back(to_world(import, paths[i], frame, known) * bind[i]);
    }
    return poses;
}

void check_joints(const Import& import, const Mesh& mesh, size_t joint_count)
{
    for (const Influences& vertex : mesh.skin.vertices)
        for (size_t i = 0; i < vertex.weights.size(); ++i)
            if (vertex.weights[i] > 0 && vertex.joints[i] >= joint_count)
                import.fail("mesh '{}': a vertex follows joint {}, but the skin has {} joints", mesh.name,
                            vertex.joints[i], joint_count);
}

void bend(Mesh& mesh, const JointPoses& joints)
{
    const bool mirrors = !mesh.skin.vertices.empty() &&
                         glm::determinant(glm::dmat3(blended(mesh.skin.vertices.front(), joints->front()))) < 0;
    for (size_t i = 0; i < mesh.skin.vertices.size(); ++i)
        move_vertex(blended(mesh.skin.vertices[i], joints->front()), mesh.positions_ws[i], mesh.vertices[i]);
    for (size_t i = 0; mirrors && i + 2 < mesh.indices.size(); i += 3)
        std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
    if (joints->size() > 1 && !mesh.skin.vertices.empty())
        mesh.skin.joints = joints;
    else
        mesh.skin = {};
}

std::vector<Influences> read_influences(Import& import, const tinygltf::Primitive& primitive, size_t vertex_count,
                                        const std::vector<uint32_t>& used, const std::string& where)
{
    std::vector<Influences> influences;
    if (attribute(primitive, "JOINTS_0") < 0 || attribute(primitive, "WEIGHTS_0") < 0) return influences;
    influences.resize(used.size());
    for (size_t set : {size_t(0), size_t(1)}) {
        const std::vector<float> joints =
            rows_of(import, primitive, set == 0 ? "JOINTS_0" : "JOINTS_1", 4, vertex_count, where);
        const std::vector<float> weights =
            rows_of(import, primitive, set == 0 ? "WEIGHTS_0" : "WEIGHTS_1", 4, vertex_count, where);
        if (joints.empty() || weights.empty()) break;
        for (size_t i = 0; i < used.size(); ++i)
            for (size_t c = 0; c < 4; ++c) {
                const float weight = weights[4 * used[i] + c];
                const float joint  = joints[4 * used[i] + c];
                if (!(weight > 0 && std::isfinite(weight) && joint >= 0 && joint <= 65535)) continue;
                influences[i].joints[4 * set + c]  = static_cast<uint32_t>(joint);
                influences[i].weights[4 * set + c] = weight;
            }
    }
    if (attribute(primitive, "JOINTS_2") >= 0)
        import.warn("vertices that follow more than 8 joints are not supported: the first 8 count");
    for (Influences& vertex : influences) {
        float sum = 0;
        for (const float weight : vertex.weights) sum += weight;
        for (float& weight : vertex.weights) weight = sum > 0 ? weight / sum : 0;
    }
    return influences;
}

} // namespace ssrlab::gltf
