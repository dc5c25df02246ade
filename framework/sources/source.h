// A source: where the answer to a reflected ray may come from. Each has a file in this folder. Sources are asked in
// order, and each gets the rays that have no certain answer yet (answer_rays.h).
#pragma once

#include "core/gbuffer_image.h"
#include "core/ray_answer.h"
#include "frame/stage.h"

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace ssrlab {

/// A ray that a source is asked about, in world space.
struct OpenRay {
    size_t     pixel = 0; // index of the reflecting pixel
    glm::dvec3 origin_ws{0};
    glm::dvec3 direction_ws{0}; // unit
    double     eye_m     = 0;   // from the eye to the origin
    double     clear_m   = 0;   // it is known to meet nothing nearer
    double     reach_m   = 0;   // nothing farther counts; may be +inf
    double     roughness = 0;   // of the reflecting surface: it blurs highlights
};

/// A list of rays that a source traced in a G-buffer.
struct TracedList {
    const GBufferPtr&           gbuffer;
    const GBufferImage&         image; // the same on the host, with its layers
    const TraceSettings&        settings;
    std::span<const RayInput>   rays;
    std::span<const RayOutcome> outcomes; // without counts
};

/// A traced frame and what sources need besides.
struct SourceContext {
    Stage&               stage;
    LabPtr               lab;          // of the frame
    TraceSettings        trace;        // likewise
    GBufferImage         image;        // what the stage shows, on the host
    ParameterValues      parameters;   // of the source that is asked
    TraceImage           traced;       // results of the frame's rays
    std::vector<OpenRay> rays;         // these rays, at most one of each pixel
    double               draw_ms  = 0; // of the frame's G-buffer
    double               trace_ms = 0; // of the frame: ray set-up, structures, trace
    std::vector<View>    earlier;      // of the frames before this one, the latest first; empty: a single frame
    std::function<void(const TracedList&)> watch; // is told of every list that is traced; empty: nobody is
};

struct Source {
    std::string              id, summary;
    std::vector<std::string> cite       = {};
    std::vector<Parameter>   parameters = {};
    /// Answers each ray. The loop sets `source`, `pixels` and merge_ms of the turn.
    SourceTurn (*answer)(SourceContext&, std::span<const OpenRay>);
};

Source frame_source();
Source resume_source();
Source layers_source();
Source wider_source();
Source cube_source();
Source views_source();
Source past_source();
Source planar_source();
Source probe_source();
Source world_source();
/// Stands for a list that choose_sources() finds, and cannot be asked itself.
Source auto_source();

/// Returns all sources, cheapest first, as lists usually name them.
std::span<const Source> all_sources();

/// A source of a list, with the values of its parameters.
struct ListedSource {
    const Source*   source = nullptr;
    std::string     text; // as in the list: "layers:count=4:sides=both"
    ParameterValues values;
};

/// Reads a list such as "frame,layers:count=4,world". Throws SpecError "PLACE: …" for an unknown source or parameter,
/// a value out of range, an empty list, and `auto` beside others.
std::vector<ListedSource> parse_sources(const std::string& text, const std::string& place);

} // namespace ssrlab
