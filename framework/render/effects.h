// The passes of a frame as one table, and the plan: which of them this picture calls for, and why.
#pragma once

#include "render/technique.h"
#include "shared.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace ssrlab {

/// What is known of scene and technique before anything is drawn.
struct FrameFacts {
    bool                     scene           = false; // the G-buffer was drawn from one
    bool                     environment_map = false; // otherwise one colour arrives from everywhere
    bool                     alpha_mask      = false;
    std::vector<std::string> structures; // that the technique reads
};

/// shaders/rays/classification.comp counts these on the G-buffer.
struct PictureCounts {
    uint32_t                             surface_pixels = 0, reflecting_pixels = 0, reflecting_tiles = 0;
    std::array<uint32_t, ROUGHNESS_BINS> roughness_pixels{}; // of reflecting pixels; bin 0: roughness 0
};

/// shaders/trace/trace_statistics.comp counts these after tracing.
struct TraceCounts {
    uint32_t rays = 0, hits = 0, mirror_hits = 0; // mirror hits: what was hit reflects, too
};

struct FrameStatistics {
    uint32_t      pixels = 0, tiles = 0;
    PictureCounts picture;
    TraceCounts   trace;
};

enum class Call : uint8_t { off, not_needed, needed };

/// Whether an effect is called for, and the reason with the number that decided.
struct Need {
    Call        call = Call::needed;
    std::string reason;
};

/// One row of the table. Skipping an effect that is not needed leaves every bit of the picture as it is.
struct Effect {
    std::string              id, summary;
    std::vector<std::string> cite = {};
    std::string              shader;        // below shaders/
    std::vector<std::string> reads = {}, writes = {}; // as the shaders name them
    std::vector<Parameter>   parameters = {};
    Need (*need)(const FrameFacts&, const FrameStatistics&, const ParameterValues&);
    bool beyond_shading = false; // off with effect_set = shading
};

/// In the order of a frame.
std::span<const Effect> all_effects();
/// The parameters of all effects, and those of the plan itself; names are unique.
std::span<const Parameter> effect_parameters();
ParameterValues            default_effect_values();

struct PlannedEffect {
    const Effect* effect = nullptr;
    bool          runs   = false;
    std::string   reason;
};

/// What runs. With the parameter `plan` off everything runs that is not switched off.
std::vector<PlannedEffect> plan_frame(const FrameFacts& facts, const FrameStatistics& statistics,
                                      const ParameterValues& values);

/// What the plan rests on, a line each.
std::vector<std::string> describe_facts(const FrameFacts& facts, const FrameStatistics& statistics);

/// Side of the blocks of which one pixel is traced.
int trace_block_px(const ParameterValues& values);

/// effect_set = shading: nothing is needed by what the trace found.
bool shading_only(const ParameterValues& values);

} // namespace ssrlab
