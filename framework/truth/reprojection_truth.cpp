#include "truth/reprojection_truth.h"

#include "core/error.h"
#include "core/parallel_rows.h"
#include "core/pixel_index.h"
#include "truth/curved_mirror.h"
#include "truth/reflected_rays.h"
#include "truth/screen_ray.h"

#include <cmath>
#include <limits>

namespace ssrlab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// Sine of the angle between a corner's normal and the triangle's: normals are floats.
constexpr double flat_sine = 1e-5;
// A point of a plane, as a share of its distance: positions are floats.
constexpr double plane_share = 1e-4;

/// Where the mirror is in the frame before, and what it reflects.
struct Mirror {
    glm::dvec3 point_ws{0}, normal_ws{0};
    uint32_t   draw = 0;
    glm::dvec4 reflected_ws{0}; // w = 0: a direction, of the sky
};

bool is_flat(const Scene& scene, const SceneHit& hit)
{
    const glm::dvec3 normal_ws = glm::normalize(hit.normal_ws);
    for (int i : {0, 1, 2}) {
        SurfacePoint corner = hit.surface;
        corner.barycentric  = glm::dvec2(i == 1 ? 1 : 0, i == 2 ? 1 : 0);
        if (!(glm::length(glm::cross(shading_normal_ws(scene, corner), normal_ws)) < flat_sine)) return false;
    }
    return true;
}

class Frames {
public:
    Frames(const SceneBvh& now, const SceneBvh& before, const GBufferImage& gbuffer, const FrameMotion& motion)
        : now_(now), gbuffer_(gbuffer), motion_(motion), before_(before, motion.previous_view),
          reflected_(now, now.scene(), gbuffer, infinity), sight_now_(now, gbuffer.view)
    {
    }

    /// What pixel (x, y) shows, and where that was.
    void solve(glm::ivec2 pixel, ReprojectionTruth& truth) const
    {
        const size_t   i       = pixel_index(pixel, gbuffer_.view.size_px);
        const SceneHit surface = sight_now_.first_drawn(glm::dvec2(pixel) + 0.5);
        truth.cls[i]           = ReprojectionClass::unknown;
        if (!surface.met || surface.surface.draw + 1 != gbuffer_.object_id[i]) return;
        const Draw& draw = now_.scene().draws[surface.surface.draw];
        if (now_.scene().materials[draw.material].normal_texture.texture >= 0) return;
        const Mirror mirror = mirror_before(pixel, surface);
        if (std::isnan(mirror.point_ws.x) || std::isnan(mirror.reflected_ws.x)) return; // bent by joints
        const std::optional<glm::dvec2> answer =
            is_flat(now_.scene(), surface) ? flat_answer(mirror) : curved_answer(pixel, mirror);
        if (!answer) return;
        truth.cls[i]             = classify(mirror, *answer, is_flat(now_.scene(), surface));
        const glm::dvec2 jitter  = gbuffer_.view.centre_px - motion_.view.centre_px;
        truth.displacement_px[i] = *answer - (glm::dvec2(pixel) + 0.5 - jitter);
    }

private:
    Mirror mirror_before(glm::ivec2 pixel, const SceneHit& surface) const
    {
        const SceneRay ray = reflected_.ray_from(pixel, mirror_direction_vs(gbuffer_, pixel));
        SceneHit       end;
        now_.intersect(std::span(&ray, 1), std::span(&end, 1));
        const glm::dmat4& back = motion_.to_previous_ws[surface.surface.draw];
        Mirror            mirror;
        mirror.draw      = surface.surface.draw;
        mirror.point_ws  = glm::dvec3(back * glm::dvec4(ray.origin_ws, 1));
        mirror.normal_ws = glm::dmat3(back) * glm::normalize(surface.normal_ws);
        // The sky does not move.
        mirror.reflected_ws =
            end.met ? motion_.to_previous_ws[end.surface.draw] * glm::dvec4(ray.origin_ws + end.t * ray.direction_ws, 1)
                    : glm::dvec4(ray.direction_ws, 0);
        return mirror;
    }

    glm::dvec4 mirror_image(const Mirror& mirror) const
    {
        const glm::dvec3 n = mirror.normal_ws;
        const double     d = glm::dot(n, glm::dvec3(mirror.reflected_ws) - mirror.reflected_ws.w * mirror.point_ws);
        return mirror.reflected_ws - glm::dvec4(2 * d * n, 0);
    }

    /// Far to the side where the eye cannot see it: off the screen.
    std::optional<glm::dvec2> flat_answer(const Mirror& mirror) const
    {
        return before_.project(mirror_image(mirror)).value_or(glm::dvec2(-infinity));
    }

    std::optional<glm::dvec2> curved_answer(glm::ivec2 pixel, const Mirror& mirror) const
    {
        const glm::dvec2        jitter = gbuffer_.view.centre_px - motion_.view.centre_px;
        std::vector<glm::dvec2> starts{glm::dvec2(pixel) + 0.5 - jitter};
        for (const glm::dvec4& guess : {glm::dvec4(mirror.point_ws, 1), mirror_image(mirror)})
            if (const auto start = before_.project(guess)) starts.push_back(*start);
        return curved_reflection(before_, mirror.draw, mirror.reflected_ws, starts);
    }

    ReprojectionClass classify(const Mirror& mirror, glm::dvec2 at_px, bool flat) const
    {
        const glm::dvec2 size(gbuffer_.view.size_px);
        if (!(at_px.x >= 0 && at_px.y >= 0 && at_px.x < size.x && at_px.y < size.y))
            return ReprojectionClass::off_screen;
        const SceneRay sight = before_.ray(at_px);
        const SceneHit hit   = before_.first_drawn(at_px);
        if (!hit.met) return ReprojectionClass::hidden;
        const glm::dvec3 point_ws = sight.origin_ws + hit.t * sight.direction_ws;
        const double     off_m    = std::abs(glm::dot(mirror.normal_ws, point_ws - mirror.point_ws));
        const bool       other =
            hit.surface.draw != mirror.draw || (flat && off_m > plane_share * hit.t * glm::length(sight.direction_ws));
        if (other) return ReprojectionClass::hidden;
        const glm::dvec3 towards_ws = glm::dvec3(mirror.reflected_ws) - mirror.reflected_ws.w * point_ws;
        const bool       sky        = mirror.reflected_ws.w == 0;
        const double     start = self_hit_share * hit.t * glm::length(sight.direction_ws) / glm::length(towards_ws);
        const SceneRay   ray{point_ws, towards_ws, start, sky ? infinity : 1 - visibility_tolerance};
        SceneHit         blocker;
        before_.bvh().intersect(std::span(&ray, 1), std::span(&blocker, 1));
        return blocker.met ? ReprojectionClass::hidden : ReprojectionClass::seen;
    }

    const SceneBvh&     now_;
    const GBufferImage& gbuffer_;
    const FrameMotion&  motion_;
    Sight               before_;
    ReflectedRays       reflected_;
    Sight               sight_now_;
};

} // namespace

ReprojectionTruth reprojection_truth(const SceneBvh& now, const SceneBvh& before, const GBufferImage& gbuffer,
                                     const FrameMotion& motion, unsigned threads)
{
    require_complete(gbuffer);
    const glm::ivec2  size_px = gbuffer.view.size_px;
    ReprojectionTruth truth{size_px, {}, {}};
    truth.cls.resize(pixel_count(size_px));
    truth.displacement_px.resize(pixel_count(size_px));
    const Frames frames(now, before, gbuffer, motion);
    parallel_rows(size_px.y, threads, [&](int y) {
        for (int x = 0; x < size_px.x; ++x)
            if (reflects(gbuffer, {x, y})) frames.solve({x, y}, truth);
    });
    return truth;
}

} // namespace ssrlab
