// Everything about one mirror ray: what each technique read, where it ended, and where it should have ended.
#pragma once

#include "check/setup.h"
#include "core/truth_class.h"

#include <nlohmann/json_fwd.hpp>

#include <optional>

namespace ssrlab {

/// A technique with its values; its ray is recorded.
struct RayQuestion {
    const Technique* technique = nullptr;
    ParameterValues  values;
};

/// Where the ray ends among the scene's triangles.
struct TrueEnd {
    TruthClass cls        = TruthClass::not_traced;
    double     distance_m = 0; // infinite for sky
    glm::dvec2 point_px{0};
    bool       starts_off_surface = false; // the drawn depth is off every surface of the scene, so the end may be false
};

/// What a visited pixel or cell holds, and the part of the ray there. Distances are along the view axis.
struct VisitReport {
    RayVisit visit;
    double   t_in = 0, t_out = 0;
    double   ray_in_m = 0, ray_out_m = 0;
    double   front_m = 0,
           back_m    = 0;  // of a pixel its front and back, of a cell its nearest and farthest pixel; 0: background
    const char* then = ""; // opens, skips, passes, hit, stopped
};

struct TechniqueReport {
    std::string              id;
    RayOutcome               outcome;
    std::string              ending;  // in words: where and why it stopped
    std::string              verdict; // right, or what is wrong with it
    std::vector<VisitReport> visits;
    size_t                   visit_count = 0;
};

struct RayReport {
    RayInput                     ray;
    RayOutcome                   exact;
    std::string                  exact_ending;
    std::vector<VisitReport>     walk; // of every pixel that the ray crosses, to the end of its segment
    std::optional<TrueEnd>       true_end;
    std::vector<TechniqueReport> techniques;
};

/// Reports one ray of the setup. Leaves true_end empty.
RayReport report_ray(Gpu& gpu, const Catalogue& catalogue, const Setup& setup, const RayInput& ray,
                     std::span<const RayQuestion> questions);

/// Returns the visits as a table, one per line.
std::string visits_table(const TechniqueReport& report);

nlohmann::json to_json(const RayReport& report, const Setup& setup);

} // namespace ssrlab
