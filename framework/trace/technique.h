// A technique is a folder: technique.toml describes it, trace.glsl traces.
#pragma once

#include "trace/structure.h"
#include "trace/surface.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace ssrlab {

/// A parameter that trades time for accuracy: a search for a target varies it.
struct Accuracy {
    std::string parameter;
    bool        higher_is_better = true;
};

struct Technique {
    std::string              id;   // the folder's name
    std::string              name; // title for people
    std::string              summary;
    std::vector<std::string> cite;
    std::vector<Structure>   structures;              // that it reads, and those they read, in the order of building
    bool                     exact = false;           // claims the pixel walk's answer on every ray
    std::vector<std::string> limits;                  // names of known_limits(): what it does not claim
    std::vector<std::string> bounded_by;              // parameters whose sum bounds the loop iterations of one ray
    int                      rays_per_invocation = 1; // 2: defines trace_pair() instead of trace()
    std::vector<Parameter>   parameters;              // its own, then those of its structures as "structure.parameter"
    std::filesystem::path    folder;
    std::vector<Accuracy>    accuracy = {};
    /// Those of "behind", "surface" and "thickness" that its own hit test ignores; "unknown" if its shaders may have a
    /// test of their own and the manifest does not say.
    std::vector<std::string> ignores = {};
    /// Structures that it could read but does not: id -> read.glsl.
    std::map<std::string, std::filesystem::path> unread = {};
};

/// An error that a technique may declare, unless it is exact. The check holds it to everything else.
struct Limit {
    std::string name, meaning;
};
std::span<const Limit> known_limits();

/// Reads folder/technique.toml; throws SpecError with file and line. `known`: structures that it may name.
Technique load_technique(const std::filesystem::path& folder, std::span<const Structure> known = {});

ParameterValues default_values(const Technique& technique);
/// `also`: what else may be named at this place, as settings.
const Parameter& find_parameter(const Technique& technique, const std::string& name, const std::string& place,
                                std::span<const std::string> also = {});

/// Returns the bound on the loop iterations of one ray with these values; a driver may cut loops at 65,535.
double                  iteration_bound(const Technique& technique, const ParameterValues& values);
inline constexpr double max_iterations = 60000;
/// Returns the declared bound on the loop iterations of one ray, at most max_iterations.
double declared_steps(const Technique& technique, const ParameterValues& values);
/// Throws SpecError if the values allow more than max_iterations.
void require_bounded(const Technique& technique, const ParameterValues& values);

/// Returns the macros that follow from the choices of its parameters.
std::vector<std::string> shader_macros(const Technique& technique, const ParameterValues& values);
/// Returns the folders that its shaders may include from: its own and those of its structures.
std::vector<std::filesystem::path> technique_folders(const Technique& technique);

} // namespace ssrlab
