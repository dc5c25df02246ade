// A technique is a folder: technique.toml says what it is, trace.glsl how it traces.
#pragma once

#include "trace/structure.h"
#include "trace/surface.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace ssrlab {

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
    std::vector<Structure>   structures;    // that it reads, and those they read, in the order in which they are built
    bool                     exact = false; // claims the pixel walk's answer on every ray
    std::vector<std::string> limits;        // names of known_limits(): what it does not claim
    std::vector<std::string> bounded_by;    // parameters whose sum bounds the loop iterations of one ray
    int                      rays_per_invocation = 1; // 2: defines trace_pair() in the place of trace()
    std::vector<Parameter>   parameters;              // its own, then those of its structures as "structure.parameter"
    std::filesystem::path    folder;
    std::vector<Accuracy>    accuracy = {};
    /// Of "behind", "surface" and "thickness": what its own hit test does not ask. "unknown": its shaders may have
    /// such a test, and the manifest does not say.
    std::vector<std::string> ignores = {};
    /// Structures that it could read but does not: id -> read.glsl.
    std::map<std::string, std::filesystem::path> unread = {};
};

/// What a technique that is not exact may declare that it gets wrong. The check holds it to everything else.
struct Limit {
    std::string name, meaning;
};
std::span<const Limit> known_limits();

/// Reads folder/technique.toml; throws SpecError with file and line. `known`: the structures that it may name.
Technique load_technique(const std::filesystem::path& folder, std::span<const Structure> known = {});

ParameterValues  default_values(const Technique& technique);
const Parameter& find_parameter(const Technique& technique, const std::string& name, const std::string& place);

/// Loop iterations of one ray that a launch with these values may need; a driver may cut loops at 65,535.
double                  iteration_bound(const Technique& technique, const ParameterValues& values);
inline constexpr double max_iterations = 60000;
/// The most loop iterations of one ray that a technique declares, or that any may take.
double declared_steps(const Technique& technique, const ParameterValues& values);
/// Throws SpecError when the values allow more than max_iterations.
void require_bounded(const Technique& technique, const ParameterValues& values);

/// The macros that its shader is compiled with, by the choices of its own parameters.
std::vector<std::string> shader_macros(const Technique& technique, const ParameterValues& values);
/// The technique's folder and those of its structures: where its shaders may include from.
std::vector<std::filesystem::path> technique_folders(const Technique& technique);

} // namespace ssrlab
