// Screen truth: the hit contract (docs/hit_contract.md) evaluated in double precision on the CPU, every pixel that the ray crosses.
#pragma once

#include "core/gbuffer_image.h"
#include "core/trace_result.h"
#include "truth/screen_ray.h"

#include <filesystem>
#include <vector>

namespace ssrlab {

/// Depth (> 0) of the far side of the slab that a pixel of that depth stands for.
double slab_back(const View& view, double depth, const TraceSettings& settings);

/// What one ray found. The last three fields are undefined unless hit.
struct WalkResult {
    TraceStatus status = TraceStatus::not_traced;
    uint32_t    pixels = 0; // visited; the start pixel is not one of them
    glm::ivec2  hit_pixel{0, 0};
    glm::dvec3  hit_px_depth{0};
    double      hit_t = 0;
};

/// The walk through one depth buffer. Keeps a reference to the G-buffer.
class ScreenWalk {
public:
    ScreenWalk(const GBufferImage& gbuffer, const TraceSettings& settings);

    WalkResult walk(const ScreenRay& ray) const;

private:
    /// A pixel's slab in depth, rounded outward to float: it rejects a pixel for certain, and small cells keep the walk in
    /// the cache. front = -inf on the background, so that nothing meets it.
    struct Cell {
        float front;
        float back;
    };

    bool   faces_ray(size_t index, glm::dvec3 direction_vs) const;
    double exact_back(size_t index) const;

    const GBufferImage& gbuffer_;
    TraceSettings       settings_;
    std::vector<Cell>   cells_;
};

/// Independent of every shader. threads = 0: all cores. steps counts the pixels visited.
TraceResult screen_truth(const GBufferImage& gbuffer, const TraceSettings& settings, unsigned threads = 0);

} // namespace ssrlab
