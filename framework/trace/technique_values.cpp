#include "core/error.h"
#include "core/names.h"
#include "trace/technique.h"

#include <algorithm>
#include <numeric>

namespace ssrlab {

ParameterValues default_values(const Technique& technique)
{
    ParameterValues values;
    for (const Parameter& parameter : technique.parameters) values[parameter.name] = parameter.default_value;
    return values;
}

const Parameter& find_parameter(const Technique& technique, const std::string& name, const std::string& place,
                                std::span<const std::string> also)
{
    const auto found = std::ranges::find(technique.parameters, name, &Parameter::name);
    if (found != technique.parameters.end()) return *found;
    std::vector<std::string> known;
    std::ranges::transform(technique.parameters, std::back_inserter(known), &Parameter::name);
    throw_spec_error("{}: {}", place, unknown_name("parameter of technique " + technique.id, name, known, also));
}

double iteration_bound(const Technique& technique, const ParameterValues& values)
{
    return std::accumulate(technique.bounded_by.begin(), technique.bounded_by.end(), 0.0,
                           [&](double sum, const std::string& name) { return sum + values.at(name); });
}

double declared_steps(const Technique& technique, const ParameterValues& values)
{
    return technique.bounded_by.empty() ? max_iterations : iteration_bound(technique, values);
}

void require_bounded(const Technique& technique, const ParameterValues& values)
{
    const double bound = iteration_bound(technique, values);
    if (bound > max_iterations)
        throw_spec_error("technique '{}' may need {:.0f} iterations a ray; at most {:.0f} are allowed (drivers cut "
                         "longer loops silently)",
                         technique.id, bound, max_iterations);
}

std::vector<std::string> shader_macros(const Technique& technique, const ParameterValues& values)
{
    std::vector<std::string> macros;
    for (const Parameter& parameter : technique.parameters)
        if (const auto define = parameter.defines.empty()
                                    ? parameter.defines.end()
                                    : parameter.defines.find(format_parameter(parameter, values.at(parameter.name)));
            define != parameter.defines.end())
            macros.push_back(define->second);
    return macros;
}

std::vector<std::filesystem::path> technique_folders(const Technique& technique)
{
    std::vector<std::filesystem::path> folders{technique.folder};
    for (const Structure& structure : technique.structures) folders.push_back(structure.folder);
    return folders;
}

} // namespace ssrlab
