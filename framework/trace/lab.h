// The tracing lab: a G-buffer in, counted hits out. It knows no scene and no effect, and needs nothing above this folder.
//
//     GBufferPtr  gbuffer = upload_gbuffer(gpu, image); // or upload_depth(), or one that frame/ drew
//     LabPtr      lab     = make_lab(gpu, catalogue, gbuffer, technique, values, settings);
//     TracerPtr   tracer  = make_tracer(gpu, lab);
//     TraceResult result  = trace_gbuffer(gpu, *tracer); // the mirror ray of every pixel that reflects
//
// trace_rays() traces any other list of rays. A lab belongs to one G-buffer, of any view, and is cheap to make: all labs
// on a G-buffer share the buffers of structures, and all labs of one device share pipelines that are the same.
#pragma once

#include "core/gbuffer_image.h"
#include "core/trace_result.h"
#include "trace/catalogue.h"

#include <memory>
#include <span>
#include <vector>

namespace ssrlab {

enum class Precision { float32, float64 };

struct GBuffer; // images of one view
struct Lab;     // one technique with one set of values under one hit contract, on one G-buffer
struct Tracer;  // its counting pipelines, with room for a list of rays

using GBufferPtr = std::shared_ptr<GBuffer>;
using LabPtr     = std::shared_ptr<const Lab>;
using TracerPtr  = std::shared_ptr<Tracer>;

/// Of a picture made elsewhere: another renderer, a test. Throws SpecError when the device cannot hold images of this size.
GBufferPtr upload_gbuffer(Gpu& gpu, const GBufferImage& image);
/// Of depth alone, for lists of rays, boxes and behind = hit: a twelfth of the memory.
GBufferPtr upload_depth(Gpu& gpu, const View& view, std::span<const float> depth);
/// What the device holds, with its layers.
GBufferImage read_gbuffer(Gpu& gpu, const GBuffer& gbuffer);

/// Layers that `settings` asks for and the G-buffer lacks become empty. Throws SpecError for a surface model that the
/// catalogue lacks and for values that allow more than max_iterations, with the technique's file and line where a shader
/// of its structures does not compile, and Failure where the device lacks what the values need.
LabPtr make_lab(Gpu& gpu, const Catalogue& catalogue, const GBufferPtr& gbuffer, const Technique& technique,
                const ParameterValues& values, const TraceSettings& settings);

/// The same technique, values and settings on another G-buffer. Throws likewise.
LabPtr lab_on(Gpu& gpu, const Lab& lab, const GBufferPtr& gbuffer);

/// What these values need and the device lacks, in words; empty: nothing.
std::string missing_feature(const Gpu& gpu, const Technique& technique, const ParameterValues& values);

/// With room for the mirror ray of every pixel that reflects. float64: the double twin; throws Failure on a device
/// without double precision. Throws SpecError with the technique's file and line when its shader does not compile.
/// Pipelines are compiled beside whatever else is done until the first trace.
TracerPtr make_tracer(Gpu& gpu, const LabPtr& lab, Precision precision = Precision::float32);
/// With room for `capacity` rays.
TracerPtr make_tracer(Gpu& gpu, const LabPtr& lab, size_t capacity, Precision precision = Precision::float32);

/// Derives the structures and traces one mirror ray of each pixel that reflects. The result is counted; what is no answer
/// has the status `impossible` (compare/validate_result.h says why).
TraceResult trace_gbuffer(Gpu& gpu, Tracer& tracer);

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

/// The mirror rays of all pixels that reflect, as the shader sets them up, in the order of its list: tiles of 8 x 8 that
/// reflect as a whole, row by row, then the others.
std::vector<RayInput> set_up_rays(Gpu& gpu, Tracer& tracer);

/// Derives the structures and traces the list. Values are rounded to the tracer's precision.
std::vector<RayOutcome> trace_rays(Gpu& gpu, Tracer& tracer, std::span<const RayInput> rays);

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
RecordedRay record_ray(Gpu& gpu, const LabPtr& lab, const RayInput& ray);

/// Puts another picture of the same size and projection in the place of the tracer's G-buffer.
void replace_picture(Gpu& gpu, Tracer& tracer, const GBufferImage& image);

} // namespace ssrlab
