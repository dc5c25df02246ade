#include "core/error.h"
#include "core/names.h"
#include "frame/passes/pass_helpers.h"
#include "sources/source.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace ssrlab {

Source auto_source()
{
    return {.id         = "auto",
            .summary    = "The list that answers most rays rightly within a budget, by a measurement of the frame",
            .parameters = {real_parameter("budget_ms", 0, 0, 1e6, "drawing the frame and its sources; 0: by `share`"),
                           real_parameter("share", 2, 1, 1000, "of the frame's own drawing and trace")},
            .answer     = [](SourceContext&, std::span<const OpenRay>) -> SourceTurn {
                throw std::logic_error("source 'auto' was asked before it was chosen");
            }};
}

std::span<const Source> all_sources()
{
    static const std::vector<Source> sources = {frame_source(), resume_source(), layers_source(), wider_source(),
                                                cube_source(),  past_source(),   planar_source(), views_source(),
                                                world_source(), probe_source(),  auto_source()};
    return sources;
}

namespace {

std::vector<std::string> split(const std::string& text, char separator)
{
    std::vector<std::string> words;
    std::istringstream       stream(text);
    for (std::string word; std::getline(stream, word, separator);) words.push_back(word);
    return words;
}

const Source& find_source(const std::string& id, const std::string& place)
{
    std::vector<std::string> known;
    for (const Source& source : all_sources()) known.push_back(source.id);
    const auto found = std::ranges::find(all_sources(), id, &Source::id);
    if (found == all_sources().end()) throw_spec_error("{}: {}", place, unknown_name("source", id, known));
    return *found;
}

void set_value(ListedSource& listed, const std::string& pair, const std::string& place)
{
    const std::string        name = pair.substr(0, pair.find('='));
    std::vector<std::string> known;
    for (const Parameter& parameter : listed.source->parameters) known.push_back(parameter.name);
    const auto found = std::ranges::find(listed.source->parameters, name, &Parameter::name);
    if (found == listed.source->parameters.end() || name == pair)
        throw_spec_error("{}: {}", place,
                         unknown_name(fmt::format("parameter of source '{}'", listed.source->id), pair, known));
    listed.values[name] = parse_parameter(*found, pair.substr(name.size() + 1), place);
}

} // namespace

std::vector<ListedSource> parse_sources(const std::string& text, const std::string& place)
{
    std::vector<ListedSource> list;
    for (const std::string& entry : split(text, ',')) {
        const std::vector<std::string> words = split(entry, ':');
        ListedSource                   listed{&find_source(words.empty() ? "" : words[0], place), entry, {}};
        for (const Parameter& parameter : listed.source->parameters)
            listed.values[parameter.name] = parameter.default_value;
        for (size_t i = 1; i < words.size(); ++i) set_value(listed, words[i], place);
        list.push_back(std::move(listed));
    }
    if (list.size() > 1 && std::ranges::any_of(list, [](const ListedSource& one) { return one.source->id == "auto"; }))
        throw_spec_error("{}: expected 'auto' alone, for it chooses the list; got '{}'", place, text);
    if (list.empty()) throw_spec_error("{}: expected a list of sources such as frame,world; got '{}'", place, text);
    return list;
}

} // namespace ssrlab
