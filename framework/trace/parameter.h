// A number or choice that a technique, a structure or a pass declares once: command line, sweeps, CSV columns, help and
// the shader's constant all come from the declaration.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace ssrlab {

enum class ParameterType { integer, real, boolean, choice };

struct Parameter {
    std::string                        name; // of a structure's "structure.parameter"
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

/// "10", "0.5", "true", "view" -> value. Throws SpecError "PLACE: …" naming parameter, expected and got (NaN included).
double parse_parameter(const Parameter& parameter, const std::string& text, const std::string& place);
/// Checks type and range; throws SpecError likewise.
void        check_parameter(const Parameter& parameter, double value, const std::string& place);
std::string format_parameter(const Parameter& parameter, double value);

} // namespace ssrlab
