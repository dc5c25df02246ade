// A parameter that a technique, structure or pass declares. Command line, sweeps, CSV columns, help and the shader's
// constant all come from the declaration.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace ssrlab {

enum class ParameterType { integer, real, boolean, choice };

struct Parameter {
    std::string                        name; // "structure.parameter" if a structure declares it
    ParameterType                      type          = ParameterType::integer;
    double                             default_value = 0; // boolean: 0 or 1; choice: index into choices
    double                             min           = 0;
    double                             max           = 0;
    std::vector<std::string>           choices; // choice only
    std::string                        doc;
    std::map<std::string, std::string> defines = {}; // choice -> macro that the shader is compiled with
};

/// Values by parameter name, in the representation of Parameter::default_value.
using ParameterValues = std::map<std::string, double>;

/// Returns the value of "10", "0.5", "true" or "view". Throws SpecError "PLACE: …" with expected and got; also for NaN.
double parse_parameter(const Parameter& parameter, const std::string& text, const std::string& place);
/// Throws SpecError likewise if the value has the wrong type or is out of range.
void        check_parameter(const Parameter& parameter, double value, const std::string& place);
std::string format_parameter(const Parameter& parameter, double value);

} // namespace ssrlab
