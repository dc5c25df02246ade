// The plan of a frame: which passes it needs, and why.
#pragma once

#include "frame/passes/pass.h"
#include "shared.h"

#include <array>

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
    std::string              motion          = {}; // what moved since the frame before, as facts_of_plan() says it
    HistoryFacts             history         = {};
    bool                     solids          = false; // the surface model asks where solids end
    std::string              reflectors      = {};    // what reflects, as facts_of_plan() says it
    int                      layers          = 1;     // that a pixel holds
    std::vector<std::string> structures;              // that the technique reads, in the order in which they are built
};

/// shaders/rays/classification.comp counts these on the G-buffer.
struct GBufferCounts {
    uint32_t                             surface_pixels = 0, reflecting_pixels = 0, reflecting_tiles = 0;
    std::array<uint32_t, ROUGHNESS_BINS> roughness_pixels{}; // of reflecting pixels; bin 0: roughness 0
    bool                                 operator==(const GBufferCounts&) const = default;
};

/// shaders/trace/trace_statistics.comp counts these after tracing.
struct TraceCounts {
    uint32_t rays = 0, hits = 0, mirror_hits = 0; // mirror hits: the hit surface reflects, too
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

/// With skip_unneeded_passes = false every pass runs that is not off.
std::vector<PlannedPass> plan_frame(const FrameFacts& facts, const FrameStatistics& statistics,
                                    const ParameterValues& values);

/// "12.5 %"
std::string percent(uint32_t part, uint32_t whole);

/// What the plan rests on, a line each.
std::vector<std::string> describe_facts(const FrameFacts& facts, const FrameStatistics& statistics);

} // namespace ssrlab
