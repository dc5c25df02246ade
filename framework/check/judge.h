// Judges the answer of one ray in double precision, with room for what single precision cannot decide.
#pragma once

#include "check/setup.h"
#include "truth/pixel_surface.h"

#include <limits>
#include <optional>
#include <string>

namespace ssrlab {

/// How far a ray may pass through a pixel that was wrongly skipped or taken and still count as a near tie.
inline constexpr double sliver_px = 0.05;
/// Cosine between normal and ray below which rounding decides which side is met.
inline constexpr double facing_rounding = 1e-4;

enum class Verdict {
    right,
    sliver, // a near tie: not the exact answer, but rounding could decide each comparison that tells them apart
    allowed, // missed, or hit within a step, what the technique's declared limits let it
    wrong,
};

struct Judgement {
    Verdict verdict      = Verdict::right;
    double  deviation_px = 0;                // between the hit points on screen, if the ray hits in both
    bool    findable = false, found = false; // the exact answer is a hit; and the technique hits within a pixel of it
    std::string reason = {};                 // wrong only
};

/// What the technique claims.
struct Claim {
    bool may_miss_between_samples = false; // limit "point_sampled"
    bool may_miss_behind_objects  = false; // limit "stops_behind_objects"
    bool may_hit_within_a_step    = false; // limit "tests_whole_steps"
};
Claim claim_of(const Technique& technique);

/// A pixel that a ray visits, in order.
struct Visit {
    glm::ivec2   pixel{0, 0};
    double       t_in = 0, t_out = 0;
    double       z_in = 0, z_out = 0;
    PixelSurface surface;           // background: front <= 0
    double       over_back_in  = 0; // how far above the surface's back the ray enters and leaves, in depth
    double       over_back_out = 0;
    double       sampled_more  = 0;  // how much farther the back lies for one sample than for an interval
    double       contact       = 0;  // depth by which the ray overlaps what the pixel holds; negative: a gap
    double       facing        = -1; // cosine between normal and ray; -1 where it makes no difference
    int          layer         = 0;  // of the pixel
    bool         passes_behind() const { return surface.front > 0 && contact < 0 && over_back_in < 0; }
};

bool       on_image(const GBufferImage& gbuffer, glm::ivec2 pixel);
glm::ivec2 start_pixel(const GBufferImage& gbuffer, const RayInput& ray);
/// Returns how deep the ray passes through the pixel: its largest distance to the borders of the pixel.
double depth_inside_px(const RayInput& ray, const Visit& visit);

class Judge {
public:
    /// Keeps a reference to the setup. Throws Failure if its G-buffer lacks what its surface model needs.
    explicit Judge(const Setup& setup);

    /// Returns all pixels of the walk except the start pixel, each layer separately.
    std::vector<Visit> walk(const RayInput& ray) const;
    /// Returns the answer of the hit contract in double precision.
    RayOutcome exact_answer(const RayInput& ray) const;
    Judgement  judge(const RayInput& ray, const RayOutcome& outcome, const Claim& claim) const;
    /// Returns which rule for all techniques is broken: finite numbers, hits on screen, inside the segment and outside
    /// the start pixel, a status that the ray can have. Empty: none.
    std::string broken_invariant(const RayInput& ray, const RayOutcome& outcome,
                                 double most_steps = std::numeric_limits<double>::infinity()) const;

private:
    /// From which sides the ray may meet what it visits, allowing for rounding.
    struct Sides {
        bool front = true, behind = true;
    };

    /// sampled: tested by points, for which a plane has the thickness of the run.
    Visit                visit(const RayInput& ray, glm::ivec2 pixel, int layer, double t_in, double t_out,
                               bool sampled = false) const;
    double               depth_rounding(const RayInput& ray, const Visit& visit) const;
    bool                 surely_touches(const RayInput& ray, const Visit& visit) const;
    bool                 surely_ends_ray(const RayInput& ray, const Visit& visit) const;
    std::optional<Visit> possible_touch(const RayInput& ray, glm::ivec2 pixel, int layer, double more_t) const;
    Sides                sides(const RayInput& ray, const Visit& visit, const Claim& claim) const;
    std::string          unsound_side(const RayInput& ray, const RayOutcome& outcome, const Visit& wide,
                                      const Claim& claim) const;
    std::string          unsound_hit(const RayInput& ray, const RayOutcome& outcome, const Claim& claim) const;
    bool                 passes_in_sliver(const RayInput& ray, const std::vector<Visit>& visits) const;
    std::string          unsound_end(const RayInput& ray, const RayOutcome& outcome, const Claim& claim) const;
    std::string          unsound(const RayInput& ray, const RayOutcome& outcome, const Claim& claim) const;

    const Setup& setup_;
};

} // namespace ssrlab
