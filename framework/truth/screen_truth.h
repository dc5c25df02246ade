// Screen truth: the hit contract (docs/reference/hit_contract.md) evaluated in double precision on the CPU.
#pragma once

#include "core/gbuffer_image.h"
#include "core/trace_image.h"
#include "truth/pixel_surface.h"
#include "truth/screen_ray.h"

#include <filesystem>
#include <vector>

namespace ssrlab {

/// The result of one ray. The last four fields are undefined unless hit or stopped.
struct WalkResult {
    TraceStatus status = TraceStatus::not_traced;
    uint32_t    pixels = 0; // visited; the start pixel is not one of them
    glm::ivec2  hit_pixel{0, 0};
    int         hit_layer = 0;
    glm::dvec3  hit_px_depth{0};
    double      hit_t = 0;
};

/// The walk through one depth buffer. Keeps a reference to the G-buffer.
class ScreenWalk {
public:
    ScreenWalk(const GBufferImage& gbuffer, const TraceSettings& settings);

    WalkResult walk(const ScreenRay& ray) const;

private:
    /// Bounds of all that a pixel holds in all its layers, rounded outward to float. They reject most pixels, and small
    /// cells keep the walk in the cache. front = -inf for background.
    struct Cell {
        float front;
        float back;
    };

    bool ends_at(size_t index, const RayPart& part, glm::dvec3 direction_vs, WalkResult& found) const;

    const GBufferImage& gbuffer_;
    TraceSettings       settings_;
    std::vector<Cell>   cells_;
};

/// Returns the truth of every pixel; `steps` is the number of visited pixels. threads = 0: all cores.
TraceImage screen_truth(const GBufferImage& gbuffer, const TraceSettings& settings, unsigned threads = 0);

} // namespace ssrlab
