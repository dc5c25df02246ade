#include "core/error.h"
#include "core/names.h"
#include "render/technique.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

namespace ssrlab {
namespace {

std::string expectation(const Parameter& parameter)
{
    switch (parameter.type) {
    case ParameterType::boolean: return "true or false";
    case ParameterType::choice: return fmt::format("one of {}", fmt::join(parameter.choices, ", "));
    case ParameterType::integer: return fmt::format("an integer in [{}, {}]", parameter.min, parameter.max);
    case ParameterType::real: break;
    }
    return fmt::format("a number in [{}, {}]", parameter.min, parameter.max);
}

[[noreturn]] void refuse_value(const Parameter& parameter, const std::string& text, const std::string& place)
{
    throw_spec_error("{}: '{}' must be {}, got {}", place, parameter.name, expectation(parameter), text);
}

} // namespace

ParameterValues default_values(const Technique& technique)
{
    ParameterValues values;
    for (const Parameter& parameter : technique.parameters) values[parameter.name] = parameter.default_value;
    return values;
}

double parse_parameter(const Parameter& parameter, const std::string& text, const std::string& place)
{
    double value = 0;
    if (parameter.type == ParameterType::choice) {
        const auto choice = std::ranges::find(parameter.choices, text);
        if (choice == parameter.choices.end()) refuse_value(parameter, "'" + text + "'", place);
        return static_cast<double>(choice - parameter.choices.begin());
    }
    if (parameter.type == ParameterType::boolean) {
        if (text != "true" && text != "false") refuse_value(parameter, "'" + text + "'", place);
        return text == "true" ? 1 : 0;
    }
    const char* end    = text.data() + text.size();
    const auto  parsed = std::from_chars(text.data(), end, value);
    if (parsed.ec != std::errc() || parsed.ptr != end) refuse_value(parameter, "'" + text + "'", place);
    check_parameter(parameter, value, place);
    return value;
}

void check_parameter(const Parameter& parameter, double value, const std::string& place)
{
    const bool whole = parameter.type == ParameterType::real || value == std::floor(value);
    // Written so that NaN fails.
    if (!(value >= parameter.min && value <= parameter.max && whole)) {
        refuse_value(parameter, fmt::format("{}", value), place);
    }
}

std::string format_parameter(const Parameter& parameter, double value)
{
    switch (parameter.type) {
    case ParameterType::boolean: return value != 0 ? "true" : "false";
    case ParameterType::choice: return parameter.choices.at(static_cast<size_t>(value));
    default: return fmt::format("{}", value);
    }
}

const Parameter& find_parameter(const Technique& technique, const std::string& name, const std::string& place)
{
    const auto found = std::ranges::find(technique.parameters, name, &Parameter::name);
    if (found != technique.parameters.end()) return *found;
    std::vector<std::string> known;
    std::ranges::transform(technique.parameters, std::back_inserter(known), &Parameter::name);
    throw_spec_error("{}: {}", place, unknown_name("parameter of technique " + technique.id, name, known));
}

double iteration_bound(const Technique& technique, const ParameterValues& values)
{
    return std::accumulate(technique.bounded_by.begin(), technique.bounded_by.end(), 0.0,
                           [&](double sum, const std::string& name) { return sum + values.at(name); });
}

void require_bounded(const Technique& technique, const ParameterValues& values)
{
    const double bound = iteration_bound(technique, values);
    if (bound > max_iterations)
        throw_spec_error("technique '{}' may need {:.0f} iterations a ray; at most {:.0f} are allowed (drivers cut "
                         "longer loops silently)",
                         technique.id, bound, max_iterations);
}

} // namespace ssrlab
