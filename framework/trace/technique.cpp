#include "trace/technique.h"

#include "core/files.h"
#include "core/names.h"
#include "gpu/shader.h"
#include "trace/manifest.h"

#include <algorithm>
#include <regex>
#include <set>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> manifest_keys = {
    "name",    "summary",    "cite",     "structures",          "exact",     "limits",
    "ignores", "bounded_by", "accuracy", "rays_per_invocation", "parameters"};

void check_bounds(const TomlFile& file, const toml::node& node, const Technique& technique)
{
    for (const std::string& name : technique.bounded_by) {
        if (find_parameter(technique, name, toml_place(file, node)).type != ParameterType::integer) {
            throw_spec_error("{}: 'bounded_by' names '{}', which is not an integer", toml_place(file, node), name);
        }
    }
}

/// accuracy = { parameter = "steps", better = "higher" }, or a list of such tables.
void read_accuracy(const TomlFile& file, const toml::node& node, Technique& technique)
{
    std::vector<const toml::node*> nodes;
    if (const toml::array* list = node.as_array())
        for (const toml::node& one : *list) nodes.push_back(&one);
    else
        nodes.push_back(&node);
    static const std::vector<std::string> keys = {"parameter", "better"};
    for (const toml::node* one : nodes) {
        const toml::table& table = toml_table(file, *one, "accuracy");
        toml_known_keys(file, table, "field of 'accuracy'", keys);
        const toml::node& name   = manifest_key(file, table, "parameter", "'accuracy'");
        const toml::node& better = manifest_key(file, table, "better", "'accuracy'");
        const Parameter&  parameter =
            find_parameter(technique, toml_text(file, name, "parameter"), toml_place(file, name));
        if (parameter.type != ParameterType::integer && parameter.type != ParameterType::real)
            throw_spec_error("{}: 'accuracy' names '{}', which is not a number", toml_place(file, name),
                             parameter.name);
        const std::string direction = toml_text(file, better, "better");
        if (direction != "higher" && direction != "lower")
            toml_refuse(file, better, "better", "\"higher\" or \"lower\"");
        technique.accuracy.push_back({parameter.name, direction == "higher"});
    }
}

void read_limits(const TomlFile& file, const toml::node& node, Technique& technique)
{
    std::vector<std::string> known;
    std::ranges::transform(known_limits(), std::back_inserter(known), &Limit::name);
    technique.limits = read_known(file, node, "limits", "limit", known);
    if (technique.exact && !technique.limits.empty())
        throw_spec_error("{}: 'limits' contradicts 'exact': an exact technique has none", toml_place(file, node));
}

void read_ignored(const TomlFile& file, const toml::node& node, Technique& technique)
{
    static const std::vector<std::string> known = {"behind", "surface", "thickness"};
    technique.ignores                           = read_known(file, node, "ignores", "part of the hit test", known);
    if (technique.exact && !technique.ignores.empty())
        throw_spec_error("{}: 'ignores' contradicts 'exact': the hit contract has all of them", toml_place(file, node));
}

std::string shaders_below(const fs::path& folder)
{
    std::string text;
    for (const auto& entry : fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied))
        if (entry.is_regular_file() && entry.path().extension() == ".glsl") text += read_file(entry.path());
    return text;
}

/// May a test other than the hit contract's decide what is hit? By the names in its shaders: it reads a pixel itself, or neither it
/// nor a structure of its asks the contract.
bool may_test_itself(const Technique& technique)
{
    static const std::regex reads("\\b(fetch_depth|fetch_pixel)\\b");
    static const std::regex asks("\\b(test_pixel|test_sample|ends_at)\\b");
    const std::string       own = shaders_below(technique.folder);
    if (std::regex_search(own, reads)) return true;
    return !std::regex_search(own, asks) && std::ranges::none_of(technique.structures, [](const Structure& structure) {
        return std::regex_search(shaders_below(structure.folder), asks);
    });
}

} // namespace

std::span<const Limit> known_limits()
{
    static const std::vector<Limit> limits = {
        {"point_sampled", "sees the depth buffer only at its samples: misses what lies between two of them, and may "
                          "report a later surface instead"},
        {"stops_behind_objects", "gives up where it has passed behind an object: misses everything farther along"},
        {"tests_whole_steps",
         "tests a pixel against the ray's depths over a whole step: may hit a surface that the ray "
         "touches only up to one step (t of the hit / its steps) before or behind that pixel"}};
    return limits;
}

Technique load_technique(const fs::path& folder, std::span<const Structure> known)
{
    const TomlFile file = read_toml(folder / "technique.toml");
    Technique      technique;
    technique.folder = folder;
    technique.id     = read_folder_id(file, folder, "technique");
    toml_known_keys(file, file.root, "key", manifest_keys);
    read_about(file, "the technique", technique);
    if (const toml::node* node = file.root.get("structures"))
        technique.structures =
            collect_structures(toml_texts(file, *node, "structures"), known, toml_place(file, *node));
    if (const toml::node* node = file.root.get("exact")) technique.exact = toml_bool(file, *node, "exact");
    if (const toml::node* node = file.root.get("limits")) read_limits(file, *node, technique);
    if (const toml::node* node = file.root.get("ignores")) read_ignored(file, *node, technique);
    if (const toml::node* node = file.root.get("rays_per_invocation")) {
        technique.rays_per_invocation = static_cast<int>(toml_integer(file, *node, "rays_per_invocation"));
        if (technique.rays_per_invocation != 1 && technique.rays_per_invocation != 2)
            toml_refuse(file, *node, "rays_per_invocation", "1 or 2");
    }
    for (const Structure& structure : known)
        if (std::ranges::find(technique.structures, structure.id, &Structure::id) == technique.structures.end())
            technique.unread.emplace(structure.id, structure.folder / "read.glsl");
    technique.parameters = read_parameters(file);
    for (const Structure& structure : technique.structures)
        technique.parameters.insert(technique.parameters.end(), structure.parameters.begin(),
                                    structure.parameters.end());
    if (const toml::node* node = file.root.get("bounded_by")) {
        technique.bounded_by = toml_texts(file, *node, "bounded_by");
        check_bounds(file, *node, technique);
    }
    if (const toml::node* node = file.root.get("accuracy")) read_accuracy(file, *node, technique);
    if (!fs::exists(folder / "trace.glsl"))
        throw_spec_error("{}: missing; it holds the technique's trace function", short_path(folder / "trace.glsl"));
    if (!technique.exact && !file.root.contains("ignores") && may_test_itself(technique))
        technique.ignores = {"unknown"};
    return technique;
}

} // namespace ssrlab
