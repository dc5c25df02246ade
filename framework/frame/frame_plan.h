// The plan of a frame: which passes it needs, and why.
#pragma once

#include "frame/passes/pass.h"
#include "trace/counts.h"
#include "trace/reprojection_strategy.h"

namespace ssrlab {

/// Whether a frame can use the frame before it.
struct HistoryFacts {
    bool        usable  = false; // there is a history, and it is of the frame before
    bool        changes = false; // something moved or was jittered since
    std::string state   = {};    // what moved since, or why it is not usable; empty: a single frame
};

/// Facts of scene and technique, known before anything is drawn.
struct FrameFacts {
    bool                     scene           = false; // the G-buffer was drawn from one
    bool                     world           = false; // its triangles are on the device, to be traced
    bool                     environment_map = false; // if not, the environment has one colour
    bool                     alpha_mask      = false;
    std::string              motion          = {}; // what moved since the frame before, as describe_facts() says it
    HistoryFacts             history         = {};
    bool                     solids          = false; // the surface model needs the ends of solids
    std::string              reflectors      = {};    // what reflects, as describe_facts() says it
    int                      layers          = 1;     // that a pixel holds
    std::vector<std::string> structures;              // that the technique reads, in the order of building
};

/// Of rays that found no surface that the frame shows: how many are followed, and how many of these meet a triangle.
struct MissCounts {
    uint32_t followed = 0, met = 0;
};

struct FrameStatistics {
    uint32_t      pixels = 0, tiles = 0;
    GBufferCounts gbuffer;
    TraceCounts   trace;
    MissCounts    misses; // 0 unless facts.world
};

struct PlannedPass {
    const Pass* pass = nullptr;
    std::string id; // of the pass, or of the structure that it builds
    bool        runs = false;
    std::string reason;
};

/// The passes of a frame, and why. The statistics are those of the very frame that is planned.
struct FramePlan {
    FrameFacts               facts;
    FrameStatistics          statistics;
    ParameterValues          values; // of pass_parameters() and the strategy, adjusted to what this frame can do
    Reprojection             reprojection;
    std::vector<PlannedPass> passes;
    double                   counting_s = 0; // time of tracing once and counting the hits
};

/// Returns the decision for every pass. With skip_unneeded_passes = false every pass runs that is not off.
std::vector<PlannedPass> plan_passes(const FrameFacts& facts, const FrameStatistics& statistics,
                                     const ParameterValues& values);
/// Returns the plan of the unculled frame: every pass that is not off, on every surface.
FramePlan unculled(FramePlan plan);
/// Returns whether the unculled frame does more work. False with pass_set = shading.
bool skips_work(const FramePlan& plan);
bool runs(const FramePlan& plan, std::string_view pass);

/// Returns part / whole as "12.5 %".
std::string percent(uint32_t part, uint32_t whole);

/// Returns the facts behind the plan, one per line.
std::vector<std::string> describe_facts(const FramePlan& plan);

} // namespace ssrlab
