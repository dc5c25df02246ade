// Rays of the world in a G-buffer of any camera: what part of each it sees, and how far a pixel's answer can be
// trusted.
#pragma once

#include "sources/source.h"
#include "trace/lab.h"

#include <functional>
#include <optional>

namespace ssrlab {

/// From t_in to t_out metres along a ray, both ends inside the image, before the near plane, and within the reach.
struct SeenPart {
    double t_in_m = 0, t_out_m = 0; // t_out_m may be +inf
    bool   leaves = false;          // the image or the near plane end it, not the reach
};

/// Empty where the camera sees none of it behind clear_m.
std::optional<SeenPart> seen_part(const View& view, const OpenRay& ray);

/// That part as a technique gets it.
RayInput to_input(const View& view, const OpenRay& ray, const SeenPart& part);

/// Metres along the ray at which it stands `back_px` pixels before a point of the screen that it reaches, or at its
/// beginning.
double metres_before(const View& view, const OpenRay& ray, const SeenPart& part, glm::dvec3 at_px_depth,
                     double back_px);

/// Do the pixels around one hold the surface that it holds? Not at silhouettes, nor on what is thinner than a pixel.
bool neighbours_agree(const GBufferImage& image, glm::ivec2 pixel);

/// Radiance that leaves the surface of a pixel toward the camera.
glm::vec3 light_of(const GBufferImage& image, glm::ivec2 pixel);

/// Does a camera see every ray where it begins?
enum class RayStart : uint8_t {
    in_sight, // it is the camera that followed them so far, or one in the same place
    anywhere,
};

/// May a ray pass behind something that the camera shows? If not, it was in sight up to where it ended.
bool stays_in_sight(const SourceContext& context, const TraceSettings& settings);

/// What tracing made of each ray in a G-buffer.
struct GBufferTrace {
    std::vector<RayAnswer>   answers;
    std::vector<TraceStatus> status;    // not_traced: the camera sees none of it
    std::vector<double>      left_at_m; // along the ray; undefined unless it left the screen
    double                   ms = 0;
};

/// Traces what a G-buffer sees of each ray. image: the same G-buffer on the host, with its layers.
GBufferTrace trace_in_gbuffer(SourceContext& context, const GBufferPtr& gbuffer, const GBufferImage& image,
                              const TraceSettings& settings, RayStart start, std::span<const OpenRay> rays);

using TraceElsewhere = std::function<std::vector<RayAnswer>(const TraceSettings&, RayStart, std::span<const OpenRay>)>;
/// Asks a camera in another place about the rays that have no point yet, and merges what it says: for certain about
/// what it saw of a ray from its beginning to its end, else about what lies on the ray's way. trace: traces rays in
/// what that camera shows.
void ask_elsewhere(const SourceContext& context, std::span<const OpenRay> rays, std::vector<RayAnswer>& answers,
                   const TraceElsewhere& trace);

/// Megabytes of device memory of a G-buffer's images.
double megabytes_of(const GBuffer& gbuffer);

} // namespace ssrlab
