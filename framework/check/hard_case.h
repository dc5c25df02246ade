// The catalogue of hard cases (docs/explanation/hard_cases.md): small frames and rays, with known answers.
#pragma once

#include "check/setup.h"
#include "core/error.h"

namespace ssrlab {

/// What a ray of a case must find.
struct Expected {
    std::optional<TraceStatus> status = TraceStatus::hit; // none: only what follows is known
    std::optional<glm::ivec2>  pixel  = {};               // of the hit
    std::optional<double>      t      = {};               // of the hit, within 1e-4
    std::optional<glm::dvec2>  end_px = {};               // where the ray must end on screen, within 0.001 px
};

/// Another setup whose answers must be equal, ray by ray, after `back` has mapped them.
struct Relation {
    std::string                           name;
    std::function<Setup(const Setup&)>    change;
    std::function<RayOutcome(RayOutcome)> back      = [](RayOutcome outcome) { return outcome; };
    bool                                  compare_t = true; // bit by bit; else status and pixel only
};

struct HardCase {
    std::string                         name;
    std::string                         breaks; // why tracers fail here
    std::string                         answer; // the expected answer and where it comes from
    std::function<std::vector<Setup>()> setups;
    /// The closed form, if there is one. Every ray is also compared with the screen truth.
    std::function<std::optional<Expected>(const Setup&, const RayInput&)> expected = {};
    /// Relations for exact techniques; others are held only to mirror images and repetition.
    std::vector<Relation> relations = {};
    /// Changes parameters of the technique for this case; the others keep their defaults.
    std::function<void(const Technique&, ParameterValues&)> adjust = {};
    /// Bound on the iterations per ray of an exact technique, if it is less than 2 (W + H - 1) + start level.
    std::function<int(const Setup&)> most_steps = {};
    /// The setups are frames that follow each other.
    bool in_order = false;
};

/// Returns the values of the technique as the case changes them.
ParameterValues adjusted(const HardCase& hard_case, const Technique& technique, ParameterValues values);

/// Something that must be refused, with a message that names the culprit.
struct RefusedCase {
    std::string           name;
    std::function<void()> attempt; // throws SpecError
    std::string           named;   // a part of its message
};

struct CaseFamily {
    std::string              name;
    std::vector<HardCase>    cases;
    std::vector<RefusedCase> refused = {};
};

/// All families, in the order of the table.
const std::vector<CaseFamily>& hard_cases();

CaseFamily direction_cases();
CaseFamily border_cases();
CaseFamily depth_cases();
CaseFamily format_cases();
CaseFamily size_cases();
CaseFamily camera_cases();
CaseFamily scale_cases();
CaseFamily rounding_cases();
CaseFamily surface_cases();
CaseFamily plane_cases();
CaseFamily normal_cases();
CaseFamily parameter_cases();
CaseFamily motion_cases();

} // namespace ssrlab
