// World-space rays in a G-buffer of any camera: which part of each ray it sees, and whether a pixel's answer can be
// trusted.
#pragma once

#include "sources/source.h"
#include "trace/lab.h"
#include "world/occupancy.h"
#include "world/world.h"

#include <functional>
#include <optional>

namespace ssrlab {

/// The part of a ray from t_in_m to t_out_m metres: inside the image, beyond the near plane, and within reach.
struct SeenPart {
    double t_in_m = 0, t_out_m = 0; // t_out_m may be +inf
    bool   leaves = false;          // it ends at the image border or the near plane, not at the reach
};

/// Returns the ray from t_min_m on as shaders get it, rounded to floats.
WorldRay to_world_ray(const OpenRay& ray, double t_min_m);

/// Returns the part beyond clear_m that the camera sees; nullopt if it sees none.
std::optional<SeenPart> seen_part(const View& view, const OpenRay& ray);

/// Returns that part as techniques get it.
RayInput to_input(const View& view, const OpenRay& ray, const SeenPart& part);

/// Returns a place some pixels before the end of what is known to be clear, or the beginning of what the camera sees.
double before_clear_end_m(const View& view, const OpenRay& ray);

/// Returns whether a ray may meet anything up to to_m where the camera does not see it: behind this layer. The grid
/// says what may be there.
bool may_meet_behind(const GBufferImage& layer, const Occupancy& grid, const OpenRay& ray, double to_m);

/// Makes `answer` the point where a ray met `pixel` of `met`: its place in the world, its light toward the camera, and
/// whether it is certain. It is if the ray stayed in sight and the four pixels around the place show the same surface,
/// which they do not at silhouettes and on things thinner than two pixels. Leaves clear_m as it is.
void set_point(RayAnswer& answer, const GBufferImage& met, glm::ivec2 pixel, glm::dvec3 at_px_depth, bool in_sight);

/// Makes `answer` say that the ray meets nothing: its light is the environment's. Leaves clear_m as it is.
void set_nothing(RayAnswer& answer, const SourceContext& context, const OpenRay& ray, bool certain);

/// Returns what a ray says that was traced in `image` (with its layers): `outcome` is how it ended, at_px_depth where.
/// If it stayed in sight, it is clear up to 2 pixels before the place where it was lost.
RayAnswer to_answer(const SourceContext& context, const GBufferImage& image, const OpenRay& ray, const SeenPart& part,
                    const RayOutcome& outcome, glm::dvec3 at_px_depth, bool in_sight);

/// Moves the clear_m of open answers on through the empty cells of the scene's grid. Where they reach to the end, the
/// answer is that the ray meets nothing, for certain. Does nothing to answers without a clear distance. `answers`: of
/// each ray. Returns the time on the device in milliseconds.
double cross_empty_cells(std::span<RayAnswer> answers, SourceContext& context, std::span<const OpenRay> rays);

/// Whether a camera sees every ray where it begins.
enum class RayStart : uint8_t {
    in_sight,   // yes
    from_frame, // yes, but for rays that the frame lost sight of: the camera stands where the frame's does
    if_shown,   // yes: rays that begin behind what the picture shows are not traced
    anywhere,
};

/// Returns whether a camera sees a ray where it begins.
bool begins_in_sight(const SourceContext& context, RayStart start, const OpenRay& ray);

/// Returns whether no ray may pass behind what the camera shows: then it was in sight up to where it ended.
bool stays_in_sight(const SourceContext& context, const TraceSettings& settings);

/// Returns these settings changed so that stays_in_sight() is true, with one layer.
TraceSettings in_sight_settings(const TraceSettings& settings);

/// The results of tracing rays in a G-buffer, one entry per ray.
struct GBufferTrace {
    std::vector<RayAnswer>   answers;
    std::vector<TraceStatus> status;    // not_traced: the camera sees none of it
    std::vector<double>      left_at_m; // along the ray; undefined unless it left the screen
    double                   ms = 0;
};

/// Traces the part of each ray that a G-buffer sees. `image`: the same G-buffer on the host, with its layers.
GBufferTrace trace_in_gbuffer(SourceContext& context, const GBufferPtr& gbuffer, const GBufferImage& image,
                              const TraceSettings& settings, RayStart start, std::span<const OpenRay> rays);

using TraceElsewhere = std::function<std::vector<RayAnswer>(const TraceSettings&, RayStart, std::span<const OpenRay>)>;
/// Asks a camera elsewhere about the rays that have no point yet, and merges its answers. An answer is certain if the
/// camera saw the ray from its beginning to its end. `trace`: traces rays in the frame
/// of that camera.
void ask_elsewhere(const SourceContext& context, std::span<const OpenRay> rays, std::vector<RayAnswer>& answers,
                   const TraceElsewhere& trace);

/// Returns the device memory of a G-buffer's images in megabytes.
double megabytes_of(const GBuffer& gbuffer);

} // namespace ssrlab
