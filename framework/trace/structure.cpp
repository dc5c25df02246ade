#include "trace/structure.h"

#include "core/names.h"
#include "trace/manifest.h"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> structure_keys = {"name", "summary", "cite", "reads", "parameters", "buffers", "passes"};
const std::vector<std::string> buffer_keys    = {"per", "count", "tile_px", "type"};
const std::vector<std::string> pass_keys      = {
         "shader", "style", "per", "tile_px", "first_level", "last_level", "levels_per_dispatch", "cells_per_invocation"};
const std::vector<std::string> element_types = {"uint", "uvec2", "uvec4", "float", "vec2", "vec4", "real2"};

const std::map<std::string, PassStyle> pass_styles = {{"serial", PassStyle::serial}, {"parallel", PassStyle::parallel}};

const std::map<std::string, SizeRule> buffer_rules = {{"pixel", SizeRule::pixel},
                                                      {"tile", SizeRule::tile},
                                                      {"cell", SizeRule::cell},
                                                      {"depth_cell", SizeRule::depth_cell},
                                                      {"ray_group", SizeRule::ray_group}};
const std::map<std::string, SizeRule> pass_rules   = {{"pixel", SizeRule::pixel},
                                                      {"tile", SizeRule::tile},
                                                      {"level", SizeRule::level},
                                                      {"ray_group", SizeRule::ray_group}};

template <typename Value>
Value read_word(const TomlFile& file, const toml::node& node, const std::string& name, const char* kind,
                const std::map<std::string, Value>& words)
{
    const std::string text  = toml_text(file, node, name);
    const auto        found = words.find(text);
    if (found != words.end()) return found->second;
    std::vector<std::string> known;
    for (const auto& [word, value] : words) known.push_back(word);
    throw_spec_error("{}: {}", toml_place(file, node), unknown_name(kind, text, known));
}

SizeRule read_rule(const TomlFile& file, const toml::table& table, const std::string& owner,
                   const std::map<std::string, SizeRule>& rules)
{
    return read_word(file, manifest_key(file, table, "per", owner), "per of " + owner, "size rule", rules);
}

int read_integer(const TomlFile& file, const toml::node& node, const std::string& name, int64_t min, int64_t max)
{
    const int64_t value = toml_integer(file, node, name);
    if (value < min || value > max) toml_refuse(file, node, name, fmt::format("an integer in [{}, {}]", min, max));
    return static_cast<int>(value);
}

int read_optional(const TomlFile& file, const toml::table& table, const std::string& key, const std::string& owner,
                  int fallback, int min, int max)
{
    const toml::node* node = table.get(key);
    return node == nullptr ? fallback : read_integer(file, *node, key + " of " + owner, min, max);
}

/// Required for tiles, refused for all else.
int read_tile_px(const TomlFile& file, const toml::table& table, const std::string& owner, SizeRule per)
{
    constexpr int largest = 1024;
    if (per == SizeRule::tile) {
        manifest_key(file, table, "tile_px", owner);
        return read_optional(file, table, "tile_px", owner, 0, 1, largest);
    }
    if (const toml::node* node = table.get("tile_px"))
        throw_spec_error("{}: 'tile_px' belongs to per = \"tile\"", toml_place(file, *node));
    return 0;
}

StructureBuffer read_buffer(const TomlFile& file, const toml::key& key, const toml::node& node)
{
    constexpr int      most_elements = 4096;
    const std::string  owner         = fmt::format("buffer '{}'", key.str());
    const toml::table& table         = toml_table(file, node, owner);
    StructureBuffer    buffer;
    buffer.name = key.str();
    if (const std::string fault = glsl_name_fault(buffer.name); !fault.empty())
        throw_spec_error("{}:{}: buffer '{}' is not a name that GLSL accepts: {}", file.path, key.source().begin.line,
                         buffer.name, fault);
    toml_known_keys(file, table, "field of " + owner, buffer_keys);
    buffer.per     = read_rule(file, table, owner, buffer_rules);
    buffer.tile_px = read_tile_px(file, table, owner, buffer.per);
    buffer.count   = read_optional(file, table, "count", owner, 1, 1, most_elements);
    if (buffer.per == SizeRule::depth_cell) {
        for (const char* fixed : {"type", "count"})
            if (const toml::node* given = table.get(fixed))
                throw_spec_error("{}: '{}' is fixed for per = \"depth_cell\": two words a cell",
                                 toml_place(file, *given), fixed);
        return buffer;
    }
    const toml::node& type = manifest_key(file, table, "type", owner);
    buffer.type            = toml_text(file, type, "type of " + owner);
    if (std::ranges::count(element_types, buffer.type) == 0)
        throw_spec_error("{}: {}", toml_place(file, type), unknown_name("element type", buffer.type, element_types));
    if (buffer.type == "real2" && buffer.per != SizeRule::ray_group)
        throw_spec_error("{}: 'real2' belongs to per = \"ray_group\": what is built on depth is float in the double "
                         "twin, too",
                         toml_place(file, type));
    return buffer;
}

StructurePass read_pass(const TomlFile& file, const toml::node& node, const Structure& structure)
{
    constexpr int      most_levels = 31, most_cells = 8;
    const std::string  owner = "a pass of " + structure.id;
    const toml::table& table = toml_table(file, node, "passes");
    toml_known_keys(file, table, "field of a pass", pass_keys);
    const toml::node& shader = manifest_key(file, table, "shader", owner);
    StructurePass     pass;
    pass.shader = structure.folder / toml_text(file, shader, "shader of " + owner);
    if (!fs::exists(pass.shader))
        throw_spec_error("{}: shader '{}' is not there", toml_place(file, shader), short_path(pass.shader));
    if (const toml::node* style = table.get("style"))
        pass.style = read_word(file, *style, "style of " + owner, "pass style", pass_styles);
    pass.per     = read_rule(file, table, owner, pass_rules);
    pass.tile_px = read_tile_px(file, table, owner, pass.per);
    for (const char* key : {"first_level", "last_level", "levels_per_dispatch", "cells_per_invocation"})
        if (const toml::node* given = table.get(key); given != nullptr && pass.per != SizeRule::level)
            throw_spec_error("{}: '{}' belongs to per = \"level\"", toml_place(file, *given), key);
    pass.first_level         = read_optional(file, table, "first_level", owner, 1, 1, most_levels);
    pass.levels_per_dispatch = read_optional(file, table, "levels_per_dispatch", owner, 1, 1, most_levels);
    if (const toml::node* last = table.get("last_level")) {
        if (last->is_string()) {
            const std::string name = toml_text(file, *last, "last_level");
            const auto parameter = std::ranges::find(structure.parameters, structure.id + "." + name, &Parameter::name);
            if (parameter == structure.parameters.end() || parameter->type != ParameterType::integer)
                throw_spec_error("{}: 'last_level' names '{}', which is no integer parameter of {}",
                                 toml_place(file, *last), name, structure.id);
            pass.last_level = parameter->name;
        } else {
            pass.last_level = read_integer(file, *last, "last_level of " + owner, 1, most_levels);
        }
    }
    if (const toml::node* cells = table.get("cells_per_invocation")) {
        const toml::array* pair = cells->as_array();
        if (pair == nullptr || pair->size() != 2) toml_refuse(file, *cells, "cells_per_invocation", "two integers");
        for (int axis : {0, 1})
            pass.cells_per_invocation[axis] =
                read_integer(file, *pair->get(static_cast<size_t>(axis)), "cells_per_invocation", 1, most_cells);
    }
    return pass;
}

/// A device runs the passes of one style.
void require_both_styles(const TomlFile& file, const toml::node& passes, const Structure& structure)
{
    const auto has = [&](PassStyle style) {
        return std::ranges::find(structure.passes, style, &StructurePass::style) != structure.passes.end();
    };
    const bool serial = has(PassStyle::serial);
    if (serial != has(PassStyle::parallel))
        throw_spec_error("{}: passes of style \"{}\" need others of style \"{}\" that make the same",
                         toml_place(file, passes), serial ? "serial" : "parallel", serial ? "parallel" : "serial");
}

} // namespace

Structure load_structure(const fs::path& folder)
{
    const TomlFile file = read_toml(folder / "structure.toml");
    Structure      structure;
    structure.folder = folder;
    structure.id     = read_folder_id(file, folder, "structure");
    toml_known_keys(file, file.root, "key", structure_keys);
    read_about(file, "the structure", structure);
    if (const toml::node* node = file.root.get("reads")) structure.reads = toml_texts(file, *node, "reads");
    structure.parameters = read_parameters(file);
    for (Parameter& parameter : structure.parameters) parameter.name.insert(0, structure.id + ".");
    for_each_in_order(toml_table(file, manifest_key(file, file.root, "buffers", "the structure"), "buffers"),
                      [&](const toml::key& key, const toml::node& node) {
                          structure.buffers.push_back(read_buffer(file, key, node));
                      });
    const toml::node&  passes = manifest_key(file, file.root, "passes", "the structure");
    const toml::array* list   = passes.as_array();
    if (list == nullptr || list->empty()) toml_refuse(file, passes, "passes", "a list of tables [[passes]]");
    for (const toml::node& pass : *list) structure.passes.push_back(read_pass(file, pass, structure));
    require_both_styles(file, passes, structure);
    return structure;
}

std::vector<Structure> collect_structures(std::span<const std::string> ids, std::span<const Structure> known,
                                          const std::string& place)
{
    std::vector<Structure>                  collected;
    std::vector<std::string>                open; // that are being collected
    std::function<void(const std::string&)> add = [&](const std::string& id) {
        if (std::ranges::count(open, id) > 0) throw_spec_error("{}: structure '{}' reads itself", place, id);
        if (std::ranges::find(collected, id, &Structure::id) != collected.end()) return;
        const auto found = std::ranges::find(known, id, &Structure::id);
        if (found == known.end()) {
            std::vector<std::string> names;
            std::ranges::transform(known, std::back_inserter(names), &Structure::id);
            throw_spec_error("{}: {}", place, unknown_name("structure", id, names));
        }
        open.push_back(id);
        for (const std::string& read : found->reads) add(read);
        open.pop_back();
        collected.push_back(*found);
    };
    for (const std::string& id : ids) add(id);

    std::map<std::string, std::string> owner_of; // by buffer; "" for the cells of the depth's buffer
    for (const Structure& structure : collected)
        for (const StructureBuffer& buffer : structure.buffers) {
            const bool in_depth     = buffer.per == SizeRule::depth_cell;
            const auto [it, is_new] = owner_of.emplace(in_depth ? "" : buffer.name, structure.id);
            if (is_new) continue;
            if (in_depth)
                throw_spec_error("{}: '{}' and '{}' both keep their cells in the depth's buffer", place, it->second,
                                 structure.id);
            throw_spec_error("{}: '{}' and '{}' both have a buffer '{}'", place, it->second, structure.id, buffer.name);
        }
    return collected;
}

} // namespace ssrlab
