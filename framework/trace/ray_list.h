// Rays from a list instead of from the pixels: what a technique does with exactly these rays.
#pragma once

#include "frame/frame.h"

#include <span>

namespace ssrlab {

/// A ray as a technique gets it (struct Ray of shaders/api/trace_api.glsl), and the pixel that names it.
struct RayInput {
    glm::dvec3  origin_px_depth{0}; // x_px, y_px, depth at t = 0; the tracer starts in the pixel that contains it
    glm::dvec3  delta_px_depth{0};  // to t = 1; the segment must lie on the image
    double      length_m   = 1;     // of the segment in view space; may be +inf
    TraceStatus end_status = TraceStatus::left_screen; // how the ray ends if it hits nothing
    glm::ivec2  pixel{0, 0};
};

/// What the technique returned, unfiltered: also t and pixel of a ray that hit nothing.
struct RayOutcome {
    TraceStatus status = TraceStatus::not_traced;
    glm::ivec2  hit_pixel{0, 0};
    double      t                 = 0;
    uint32_t    steps             = 0;
    uint32_t    depth_fetches     = 0;
    uint32_t    structure_fetches = 0; // without those for a whole group of rays
    uint8_t     hit_layer         = 0; // of hit_pixel; 0: the first

    bool operator==(const RayOutcome&) const = default;
};

/// One technique with one set of values on one picture's depth, ready for any number of lists.
struct RayTracer;
using RayTracerPtr = std::shared_ptr<RayTracer>;

/// Compiles the counting pipeline. capacity: the longest list.
RayTracerPtr make_ray_tracer(Gpu& gpu, const GBufferPtr& gbuffer, const Technique& technique,
                             const ParameterValues& values, const TraceSettings& settings, size_t capacity,
                             Precision precision = Precision::float32);

/// The mirror rays of all pixels that reflect, as the shader sets them up, in the order of its list: tiles of 8 x 8 that
/// reflect as a whole, row by row, then the others.
std::vector<RayInput> set_up_rays(Gpu& gpu, RayTracer& tracer);

/// Builds the structures that the technique reads and traces the list. Values are rounded to the tracer's precision.
std::vector<RayOutcome> trace_rays(Gpu& gpu, RayTracer& tracer, std::span<const RayInput> rays);

/// A pixel that a ray asked about (level 0), or the cell of a level >= 1 that holds it.
struct RayVisit {
    glm::ivec2 pixel{0, 0};
    int        level = 0;
    double t_in = -1, t_out = -1; // the interval that was asked about, one sample if equal; negative: all of the cell

    bool operator==(const RayVisit&) const = default;
};

struct RecordedRay {
    RayOutcome            outcome;
    std::vector<RayVisit> visits;          // in order: reads of pixels, and of structures that call record_visit()
    size_t                visit_count = 0; // more than `visits` has where the record was full
};

/// Traces one ray, by a pipeline that records what it looks at.
RecordedRay record_ray(Gpu& gpu, const GBufferPtr& gbuffer, const Technique& technique, const ParameterValues& values,
                       const TraceSettings& settings, const RayInput& ray);

/// Puts another picture of the same size and projection in the place of the tracer's G-buffer.
void replace_picture(Gpu& gpu, RayTracer& tracer, const GBufferImage& image);

/// A G-buffer of nothing but depth, for lists of rays with boxes, and behind = hit: a twelfth of the memory.
GBufferPtr upload_depth(Gpu& gpu, const View& view, std::span<const float> depth);

} // namespace ssrlab
