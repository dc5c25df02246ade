// Morph targets: what is added to the attributes of vertices, by weight (glTF 2.0, 3.7.2.2).
#include "scene/gltf.h"

#include <algorithm>
#include <cmath>

namespace ssrlab::gltf {

std::vector<float> morph_weights(const Import& import, int node_index)
{
    if (const auto found = import.first_weights.find(node_index); found != import.first_weights.end())
        return found->second;
    const tinygltf::Node& node = import.json.nodes[static_cast<size_t>(node_index)];
    if (!node.weights.empty()) return {node.weights.begin(), node.weights.end()};
    const std::vector<double>& weights = import.json.meshes[static_cast<size_t>(node.mesh)].weights;
    return {weights.begin(), weights.end()};
}

void add_morph_targets(const Import& import, const tinygltf::Primitive& primitive, const char* name, int components,
                       int delta_components, const std::vector<float>& weights, std::vector<float>& rows,
                       const std::string& where)
{
    const auto& targets = primitive.targets;
    if (rows.empty() || targets.empty() || weights.empty()) return;
    if (weights.size() != targets.size())
        import.fail("{}/targets: {} targets, expected {} as there are weights", where, targets.size(), weights.size());
    const auto   stride = static_cast<size_t>(components);
    const size_t count  = rows.size() / stride;
    for (size_t t = 0; t < targets.size(); ++t) {
        const auto        found = targets[t].find(name);
        const std::string place = fmt::format("{}/targets/{}/{}", where, t, name);
        if (!std::isfinite(weights[t])) import.fail("{}: its weight is not finite", place);
        if (found == targets[t].end() || weights[t] == 0) continue;
        const std::vector<float> deltas = read_floats(import, found->second, delta_components, place);
        const auto               width  = static_cast<size_t>(delta_components);
        if (deltas.size() != width * count)
            import.fail("{}: {} elements for {} positions", place, deltas.size() / width, count);
        for (size_t i = 0; i < count; ++i)
            for (size_t c = 0; c < width; ++c) rows[i * stride + c] += weights[t] * deltas[width * i + c];
    }
}

} // namespace ssrlab::gltf
