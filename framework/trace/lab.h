// The tracing lab: a G-buffer in, counted hits out. It knows no scene and no effect.
//
//     GBufferPtr  gbuffer = upload_gbuffer(gpu, image); // or upload_depth(), or one that frame/ drew
//     LabPtr      lab     = make_lab(gpu, catalogue, gbuffer, technique, values, settings);
//     TracerPtr   tracer  = make_tracer(gpu, lab);
//     TraceImage result  = trace_gbuffer(gpu, *tracer); // the mirror ray of every pixel that reflects
//
// trace_rays() traces any other list of rays. A lab belongs to one G-buffer and is cheap to make: labs on one G-buffer
// share the buffers of structures, and labs on one device share equal pipelines.
#pragma once

#include "core/gbuffer_image.h"
#include "core/trace_image.h"
#include "trace/catalogue.h"

#include <memory>
#include <span>
#include <vector>

namespace ssrlab {

/// The numbers that a technique computes with; its double twin has float64.
enum class NumberFormat { float32, float64 };

struct GBuffer; // images of one view
struct Lab;     // one technique with one set of values under one hit contract, on one G-buffer
struct Tracer;  // its counting pipelines, with room for a list of rays

using GBufferPtr = std::shared_ptr<GBuffer>;
using LabPtr     = std::shared_ptr<const Lab>;
using TracerPtr  = std::shared_ptr<Tracer>;

/// Uploads a G-buffer made elsewhere. Throws SpecError if the device cannot hold images of this size.
GBufferPtr upload_gbuffer(Gpu& gpu, const GBufferImage& image);
/// Uploads depth alone, which suffices for lists of rays with boxes and behind = hit, in a twelfth of the memory.
GBufferPtr upload_depth(Gpu& gpu, const View& view, std::span<const float> depth);
/// Downloads a G-buffer with its layers.
GBufferImage read_gbuffer(Gpu& gpu, const GBuffer& gbuffer);

/// Returns the technique with these values, ready to trace. Layers that `settings` asks for and the G-buffer lacks are
/// empty. Throws SpecError for an unknown surface model, for values that allow more than max_iterations, and, with file
/// and line, if a shader of a structure does not compile; Failure if the device lacks a feature.
LabPtr make_lab(Gpu& gpu, const Catalogue& catalogue, const GBufferPtr& gbuffer, const Technique& technique,
                const ParameterValues& values, const TraceSettings& settings);

/// Returns the same technique, values and settings on another G-buffer. Throws as make_lab() does.
LabPtr lab_on(Gpu& gpu, const Lab& lab, const GBufferPtr& gbuffer);

/// Returns the feature that these values need and the device lacks, in words; empty if there is none.
std::string missing_feature(const Gpu& gpu, const Technique& technique, const ParameterValues& values);

/// Returns a tracer with room for the mirror ray of every pixel that reflects; float64 is the double twin. Throws
/// Failure if the device lacks double precision, and SpecError with file and line if the technique's shader does not
/// compile. Pipelines compile in the background until the first trace.
TracerPtr make_tracer(Gpu& gpu, const LabPtr& lab, NumberFormat number_format = NumberFormat::float32);
/// Returns a tracer with room for `capacity` rays. Throws likewise.
TracerPtr make_tracer(Gpu& gpu, const LabPtr& lab, size_t capacity, NumberFormat number_format = NumberFormat::float32);

/// Builds the structures, traces the mirror ray of each pixel that reflects, and counts the work. A result that cannot
/// be right gets the status `impossible` (compare/validate_result.h says why).
TraceImage trace_gbuffer(Gpu& gpu, Tracer& tracer);

/// Return a tracer that counts no work, as in a frame. `capacity`: the largest list; without it, the reflecting pixels.
TracerPtr make_timed_tracer(Gpu& gpu, const LabPtr& lab, size_t capacity);
TracerPtr make_timed_tracer(Gpu& gpu, const LabPtr& lab);
/// Builds the structures and traces the rays of the last trace_gbuffer() or trace_rays() again, `times` times in one
/// submit. Returns the milliseconds that structures and trace took on the device the last time.
double time_trace(Gpu& gpu, Tracer& tracer, int times = 1);

/// A ray as techniques get it (struct Ray of shaders/api/trace_api.glsl), and the pixel that it belongs to.
struct RayInput {
    glm::dvec3  origin_px_depth{0}; // x_px, y_px, depth at t = 0; the tracer starts in the pixel that contains it
    glm::dvec3  delta_px_depth{0};  // to t = 1; the segment must lie on the image
    double      length_m   = 1;     // of the segment in view space; may be +inf
    TraceStatus end_status = TraceStatus::left_screen; // if it hits nothing
    glm::ivec2  pixel{0, 0};
};

/// What the technique returned for one ray. Nothing is filtered: t and pixel are set even without a hit.
struct RayOutcome {
    TraceStatus status = TraceStatus::not_traced;
    glm::ivec2  hit_pixel{0, 0};
    double      t                 = 0;
    uint32_t    steps             = 0;
    uint32_t    depth_fetches     = 0;
    uint32_t    structure_fetches = 0; // without those made for a whole group of rays
    uint8_t     hit_layer         = 0; // of hit_pixel; 0: the first

    bool operator==(const RayOutcome&) const = default;
};

/// Returns the mirror rays of all pixels that reflect, as the shader sets them up, in the order of its list: first the
/// tiles of 8 x 8 pixels that reflect everywhere, row by row, then the others.
std::vector<RayInput> set_up_rays(Gpu& gpu, Tracer& tracer);

/// Builds the structures and traces the list. Values are rounded to the tracer's precision.
std::vector<RayOutcome> trace_rays(Gpu& gpu, Tracer& tracer, std::span<const RayInput> rays);

/// A read of one ray: of a pixel (level 0), or of the cell of a level >= 1 that contains it.
struct RayVisit {
    glm::ivec2 pixel{0, 0};
    int        level = 0;
    double     t_in = -1, t_out = -1; // the tested interval, one sample if equal; negative: the whole cell

    bool operator==(const RayVisit&) const = default;
};

struct RecordedRay {
    RayOutcome            outcome;
    std::vector<RayVisit> visits;          // in order: reads of pixels, and of structures that call record_visit()
    size_t                visit_count = 0; // larger than visits.size() if the record was full
};

/// Traces one ray with a pipeline that records its reads.
RecordedRay record_ray(Gpu& gpu, const LabPtr& lab, const RayInput& ray);

/// Replaces the content of the tracer's G-buffer by another of the same size and projection.
void replace_picture(Gpu& gpu, Tracer& tracer, const GBufferImage& image);

} // namespace ssrlab
