// The plan of a frame: which passes it needs, and why.
#pragma once

#include "frame/passes/pass.h"
#include "trace/counts.h"
#include "trace/reprojection_strategy.h"

namespace ssrlab {

/// What a frame may take of the frame before it.
struct HistoryFacts {
    bool        usable  = false; // there is one, and it is of the frame before
    bool        changes = false; // something moved or is jittered since
    std::string state   = {};    // what moved since, or why nothing is usable; empty: a single frame
};

/// What is known of scene and technique before anything is drawn.
struct FrameFacts {
    bool                     scene           = false; // the G-buffer was drawn from one
    bool                     environment_map = false; // without a map, one colour arrives from everywhere
    bool                     alpha_mask      = false;
    std::string              motion          = {}; // what moved since the frame before, as describe_facts() says it
    HistoryFacts             history         = {};
    bool                     solids          = false; // the surface model asks where solids end
    std::string              reflectors      = {};    // what reflects, as describe_facts() says it
    int                      layers          = 1;     // that a pixel holds
    std::vector<std::string> structures;              // that the technique reads, in the order in which they are built
};

struct FrameStatistics {
    uint32_t      pixels = 0, tiles = 0;
    GBufferCounts gbuffer;
    TraceCounts   trace;
};

struct PlannedPass {
    const Pass* pass = nullptr;
    std::string id; // of the pass, or of the structure that it builds
    bool        runs = false;
    std::string reason;
};

/// What a frame does and why. The frame is still, so its statistics are its own.
struct FramePlan {
    FrameFacts               facts;
    FrameStatistics          statistics;
    ParameterValues          values; // of pass_parameters() and the reprojection strategy, as this frame can have them
    Reprojection             reprojection;
    std::vector<PlannedPass> passes;
    double                   counting_s = 0; // that it took to trace once and count what the rays hit
};

/// With skip_unneeded_passes = false every pass runs that is not off.
std::vector<PlannedPass> plan_passes(const FrameFacts& facts, const FrameStatistics& statistics,
                                     const ParameterValues& values);
/// The same frame with every pass that is not off, on every surface.
FramePlan unculled(FramePlan plan);
/// Whether the unculled frame would do more. False with pass_set = shading.
bool skips_work(const FramePlan& plan);
bool runs(const FramePlan& plan, std::string_view pass);

/// "12.5 %"
std::string percent(uint32_t part, uint32_t whole);

/// What the plan rests on, a line each.
std::vector<std::string> describe_facts(const FramePlan& plan);

} // namespace ssrlab
