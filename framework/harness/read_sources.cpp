#include "harness/read_sources.h"

namespace ssrlab {
namespace {

HandOn read_hand_on(const TomlFile& file, const toml::node& node)
{
    const auto found = std::ranges::find(hand_on_names, toml_text(file, node, "hand_on"));
    if (found == hand_on_names.end()) toml_refuse(file, node, "hand_on", "\"lost\" or \"uncertain\"");
    return static_cast<HandOn>(found - hand_on_names.begin());
}

std::vector<HandOn> read_all_hand_on(const TomlFile& file, const toml::table& table)
{
    const toml::node* node = table.get("hand_on");
    if (node == nullptr) return {HandOn::uncertain};
    std::vector<HandOn> all;
    for (const toml::node* value : toml_values(file, *node, "hand_on")) all.push_back(read_hand_on(file, *value));
    return all;
}

std::vector<AskedSources> read_table(const TomlFile& file, const toml::table& table, const MeasureSettings& measure)
{
    static const std::vector<std::string> known = {"lists", "hand_on"};
    toml_known_keys(file, table, "key of [sources]", known);
    const toml::node* lists = table.get("lists");
    if (lists == nullptr)
        throw_spec_error("{}: [sources] names no list: add lists = [\"frame,world\"]", toml_place(file, table));
    return read_source_lists(file, *lists, "lists", read_all_hand_on(file, table), measure);
}

} // namespace

std::vector<AskedSources> read_sources(const TomlFile& file, const MeasureSettings& measure)
{
    const toml::node* node = file.root.get("sources");
    if (node == nullptr) return {{}};
    std::vector<AskedSources> asked;
    for (const toml::node* value : toml_values(file, *node, "sources")) {
        const auto some = read_table(file, toml_table(file, *value, "sources"), measure);
        asked.insert(asked.end(), some.begin(), some.end());
    }
    return asked;
}

std::vector<AskedSources> read_source_lists(const TomlFile& file, const toml::node& node, const std::string& key,
                                            std::span<const HandOn> hand_on, const MeasureSettings& measure)
{
    if (!measure.truth)
        throw_spec_error("{}: sources are judged by the truths: needs truth = true in [measure], got false",
                         toml_place(file, node));
    std::vector<AskedSources> asked;
    for (const toml::node* value : toml_values(file, node, key)) {
        const std::string text = toml_text(file, *value, key);
        const auto        list = parse_sources(text, toml_place(file, *value) + ": '" + text + "'");
        for (const HandOn one : hand_on) asked.push_back({text, list, one});
    }
    return asked;
}

} // namespace ssrlab
