#include "scene/gltf.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace ssrlab::gltf {
namespace {

template <size_t count> bool all_finite(const std::vector<double>& values)
{
    return values.size() == count && std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

/// How many there are. Attributes of other names count, too: they may be the only ones.
size_t instance_count(const Import& import, const tinygltf::Value& attributes, const std::string& where)
{
    size_t count = 0;
    for (const std::string& name : attributes.Keys()) {
        const std::string place = where + "/" + name;
        if (!attributes.Get(name).IsInt()) import.fail("{}: expected the number of an accessor", place);
        const int accessor = attributes.Get(name).GetNumberAsInt();
        component_count(import, accessor, place); // checks the accessor
        const size_t found = import.json.accessors[size_t(accessor)].count;
        if (count != 0 && found != count)
            import.fail("{}: {} rows, expected {} as the others have", place, found, count);
        count = found;
    }
    if (count > max_node_visits)
        import.fail("{}: {} instances, at most {} can be loaded", where, count, max_node_visits);
    return count;
}

} // namespace

glm::dmat4 local_matrix(const Import& import, int node_index, int frame)
{
    tinygltf::Node node = import.json.nodes[static_cast<size_t>(node_index)];
    if (const auto found = import.tracks.find(node_index); found != import.tracks.end()) {
        const auto put = [&](const std::optional<Track>& track, std::vector<double>& property) {
            if (!track) return;
            const glm::dvec4 value = value_at(*track, frame / gltf_frames_per_second);
            property.clear();
            for (int c = 0; c < track->components; ++c) property.push_back(value[c]);
        };
        put(found->second.translation, node.translation);
        put(found->second.rotation, node.rotation);
        put(found->second.scale, node.scale);
    }
    const auto check = [&](const std::vector<double>& values, bool ok, const char* what) {
        if (!values.empty() && !ok) import.fail("/nodes/{}/{}: wrong length, or not finite", node_index, what);
        return !values.empty();
    };
    if (check(node.matrix, all_finite<16>(node.matrix), "matrix")) {
        glm::dmat4 matrix(1);
        for (size_t column = 0; column < 4; ++column)
            for (size_t row = 0; row < 3; ++row)
                matrix[static_cast<int>(column)][static_cast<int>(row)] = node.matrix[4 * column + row];
        return matrix; // the last row is 0 0 0 1 by definition, whatever the file says
    }
    glm::dmat4 matrix(1);
    if (check(node.translation, all_finite<3>(node.translation), "translation"))
        matrix = glm::translate(matrix, {node.translation[0], node.translation[1], node.translation[2]});
    if (check(node.rotation, all_finite<4>(node.rotation), "rotation")) {
        const glm::dquat rotation(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
        if (glm::length(rotation) > 0) matrix *= glm::mat4_cast(glm::normalize(rotation));
    }
    if (check(node.scale, all_finite<3>(node.scale), "scale"))
        matrix = glm::scale(matrix, {node.scale[0], node.scale[1], node.scale[2]});
    return matrix;
}

const tinygltf::Value* extension_of(const tinygltf::Node& node, const char* name)
{
    const auto found = node.extensions.find(name);
    return found != node.extensions.end() && found->second.IsObject() ? &found->second : nullptr;
}

bool is_hidden(const tinygltf::Node& node)
{
    const tinygltf::Value* visibility = extension_of(node, "KHR_node_visibility");
    return visibility != nullptr && visibility->Has("visible") && visibility->Get("visible").IsBool() &&
           !visibility->Get("visible").Get<bool>();
}

std::vector<glm::dmat4> instances_of(const Import& import, int node)
{
    const tinygltf::Value* extension = extension_of(import.json.nodes[size_t(node)], "EXT_mesh_gpu_instancing");
    if (extension == nullptr || !extension->Has("attributes") || !extension->Get("attributes").IsObject())
        return {glm::dmat4(1)};
    const tinygltf::Value& attributes = extension->Get("attributes");
    const std::string      where      = fmt::format("/nodes/{}/extensions/EXT_mesh_gpu_instancing/attributes", node);
    const size_t           count      = instance_count(import, attributes, where);
    std::vector<float>     rows[3]; // translation, rotation, scale
    const char* const      names[]       = {"TRANSLATION", "ROTATION", "SCALE"};
    constexpr size_t       components[3] = {3, 4, 3};
    for (size_t i = 0; i < 3; ++i) {
        if (!attributes.Has(names[i])) continue;
        const std::string place = where + "/" + names[i];
        rows[i] = read_floats(import, attributes.Get(names[i]).GetNumberAsInt(), int(components[i]), place);
        if (!std::ranges::all_of(rows[i], [](float value) { return std::isfinite(value); }))
            import.fail("{}: a value is not finite", place);
    }
    std::vector<glm::dmat4> instances(count, glm::dmat4(1));
    for (size_t k = 0; k < count; ++k) {
        const auto value = [&](size_t i, size_t c) { return double(rows[i][k * components[i] + c]); };
        if (!rows[0].empty()) instances[k] = glm::translate(instances[k], {value(0, 0), value(0, 1), value(0, 2)});
        if (!rows[1].empty()) {
            const glm::dquat rotation(value(1, 3), value(1, 0), value(1, 1), value(1, 2));
            if (glm::length(rotation) > 0) instances[k] *= glm::mat4_cast(glm::normalize(rotation));
        }
        if (!rows[2].empty()) instances[k] = glm::scale(instances[k], {value(2, 0), value(2, 1), value(2, 2)});
    }
    return instances;
}

} // namespace ssrlab::gltf
