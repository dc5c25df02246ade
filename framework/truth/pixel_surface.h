// What a pixel holds and where a ray meets it (docs/reference/hit_contract.md), in double precision.
#pragma once

#include "core/gbuffer_image.h"
#include "core/trace_image.h"

#include <limits>
#include <optional>
#include <string_view>

namespace ssrlab {

/// A sloped face, in depth.
struct Face {
    double     depth = 0; // at the pixel's centre
    glm::dvec2 gradient{0, 0};
};

/// A front and a back with the same slope, in depth, and perhaps a solid behind the back.
struct PixelSurface {
    glm::dvec2 centre_px{0, 0};
    double     front = 0;                                                   // at the centre; +inf: infinitely near
    double     back  = 0;                                                   // at the centre; -inf: there is none
    glm::dvec2 gradient{0, 0};                                              // depth per px; 0: level
    double     solid_back        = std::numeric_limits<double>::infinity(); // where the solid ends; +inf: there is none
    bool       sides_by_height   = false; // met from behind if the ray comes from below; else if the normal says so
    bool       from_outside      = false; // met where a ray crosses the front from outside; there is no back
    bool       is_far_side       = false; // of the solid behind the layer before. This and the next: if from_outside
    std::optional<Face> far_side = {};    // where the solid behind the front ends

    double front_at(glm::dvec2 position_px) const { return front + glm::dot(gradient, position_px - centre_px); }
    double back_at(glm::dvec2 position_px) const { return back + glm::dot(gradient, position_px - centre_px); }
    double far_side_at(glm::dvec2 position_px) const
    {
        return far_side->depth + glm::dot(far_side->gradient, position_px - centre_px);
    }
};

/// The part t_in … t_out of a ray origin + t * delta, in (x_px, y_px, depth).
struct RayPart {
    glm::dvec3 origin_px_depth{0};
    glm::dvec3 delta_px_depth{0};
    double     t_in = 0, t_out = 0;

    glm::dvec3 at(double t) const { return origin_px_depth + t * delta_px_depth; }
};

/// Where a ray meets a pixel; undefined unless `meets`.
struct Meeting {
    bool   meets       = false;
    bool   from_behind = false;
    double t           = 0; // where the ray first meets what the pixel holds
};

/// Returns the depth of the far side of the slab of a pixel with this depth (> 0).
double slab_back(const View& view, double depth, const TraceSettings& settings);
/// Returns the depth of the near side of the two-sided slab; +inf where it would lie at the eye or behind it.
double slab_front(const View& view, double depth, const TraceSettings& settings);
/// Returns how far the back of a plane lies below its front, in depth.
double plane_tolerance(const View& view, double depth);

/// Returns whether this file knows the surface model; models from outside the tree are not known.
bool has_screen_truth(std::string_view surface);

/// Throws SpecError unless the model is known here, and Failure unless the G-buffer has what it needs.
void require_surface(const GBufferImage& gbuffer, const TraceSettings& settings);

/// Returns what a pixel holds in a layer; nullopt for background.
std::optional<PixelSurface> pixel_surface(const GBufferImage& gbuffer, int layer, size_t index,
                                          const TraceSettings& settings);

/// Returns how many layers a pixel holds at most: those that the settings ask for and the G-buffer has.
int layer_count(const GBufferImage& gbuffer, const TraceSettings& settings);
/// Returns one layer; 0 is the G-buffer itself.
const GBufferImage& layer_of(const GBufferImage& gbuffer, int layer);

/// Returns by how much a ray comes from outside within its part, in depth: negative where it does not.
double outside_in(const PixelSurface& surface, const RayPart& ray);

/// Returns where the ray meets the pixel. `facing`: sign of normal · direction, from which side a box is met.
Meeting meet(const PixelSurface& surface, const RayPart& ray, double facing);

} // namespace ssrlab
