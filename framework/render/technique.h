// A technique is a folder: technique.toml says what it is, trace.glsl how it traces.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace ssrlab {

enum class ParameterType { integer, real, boolean, choice };

/// Declared once, in technique.toml; command line, sweeps, CSV columns, help and the shader's constant all come from here.
struct Parameter {
    std::string              name;
    ParameterType            type          = ParameterType::integer;
    double                   default_value = 0; // boolean: 0 or 1; choice: index into choices
    double                   min           = 0;
    double                   max           = 0;
    std::vector<std::string> choices; // choice only
    std::string              doc;
};

/// Values by parameter name, in the representation of Parameter::default_value.
using ParameterValues = std::map<std::string, double>;

/// A parameter that buys accuracy with time: what a search for a target turns.
struct Accuracy {
    std::string parameter;
    bool        higher_is_better = true;
};

struct Technique {
    std::string              id;   // the folder's name
    std::string              name; // title for people
    std::string              summary;
    std::vector<std::string> cite;
    std::vector<std::string> inputs;        // derived inputs, e.g. "depth_pyramid"
    bool                     exact = false; // claims the pixel walk's answer on every ray
    std::vector<std::string> limits;        // names of known_limits(): what it does not claim
    std::vector<std::string> bounded_by;    // parameters whose sum bounds the loop iterations of one ray
    std::vector<Parameter>   parameters;
    std::filesystem::path    folder;
    std::vector<Accuracy>    accuracy = {};
};

/// What a technique that is not exact may declare that it gets wrong. The check holds it to everything else.
struct Limit {
    std::string name, meaning;
};
std::span<const Limit> known_limits();

/// Reads folder/technique.toml; throws SpecError with file and line.
Technique load_technique(const std::filesystem::path& folder);

/// The in-tree techniques, then those in $SSRLAB_TECHNIQUES (colon-separated) and `extra_dirs`. Each directory is either one
/// technique's folder or holds such folders. Throws SpecError when two share an id or a directory does not exist.
std::vector<Technique> list_techniques(std::span<const std::filesystem::path> extra_dirs);

/// The technique of that id; throws SpecError listing the known ones.
const Technique& find_technique(std::span<const Technique> techniques, const std::string& id);

ParameterValues default_values(const Technique& technique);
/// "10", "0.5", "true", "view" -> value. Throws SpecError "PLACE: …" naming parameter, expected and got (NaN included).
double parse_parameter(const Parameter& parameter, const std::string& text, const std::string& place);
/// Checks type and range; throws SpecError likewise.
void             check_parameter(const Parameter& parameter, double value, const std::string& place);
std::string      format_parameter(const Parameter& parameter, double value);
const Parameter& find_parameter(const Technique& technique, const std::string& name, const std::string& place);

/// Loop iterations of one ray that a launch with these values may need; a driver may cut loops at 65,535.
double                  iteration_bound(const Technique& technique, const ParameterValues& values);
inline constexpr double max_iterations = 60000;
/// Throws SpecError when the values allow more than max_iterations.
void require_bounded(const Technique& technique, const ParameterValues& values);

} // namespace ssrlab
