#include "sources/embree.h"

#include "gpu/device.h"

namespace ssrlab::test {
namespace {

constexpr double ulps = 0x1p-20; // sixteen of the last places of a float

/// A triangle and a ray, in double precision from the floats that both walks get.
struct Meeting {
    double t      = 0;
    double sine   = 0; // of the angle between the ray and the plane
    double edge_m = 0; // from the ray to the nearest edge
    double size_m = 0; // the largest number of what was subtracted, where rounding comes from
};

Meeting meet(const Scene& scene, const SurfacePoint& surface, const WorldRay& ray)
{
    const glm::dvec3 o(ray.origin_ws), d(ray.direction_ws);
    const glm::dvec3 corner[3] = {corner_ws(scene, surface, 0), corner_ws(scene, surface, 1),
                                  corner_ws(scene, surface, 2)};
    const glm::dvec3 normal    = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    Meeting          meeting;
    meeting.t      = glm::dot(normal, corner[0] - o) / glm::dot(normal, d);
    meeting.sine   = std::abs(glm::dot(normal, d)) / (glm::length(normal) * glm::length(d));
    meeting.edge_m = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
        // Between two lines.
        const glm::dvec3 across = glm::cross(corner[(i + 1) % 3] - corner[i], d);
        meeting.edge_m = std::min(meeting.edge_m, std::abs(glm::dot(across, corner[i] - o)) / glm::length(across));
        meeting.size_m = std::max({meeting.size_m, glm::length(corner[i]), glm::length(corner[i] - o)});
    }
    meeting.size_m = std::max(meeting.size_m, glm::length(o));
    return meeting;
}

SurfacePoint surface_of(const Scene& scene, const World& world, const WorldHit& hit)
{
    const TreeTriangle& triangle = world.tree.triangles[hit.triangle];
    return {triangle.draw, (triangle.first_index - scene.draws[triangle.draw].first_index) / 3,
            glm::dvec2(hit.barycentric)};
}

/// The nearer of the two answers is one that the other walk did not take: why?
Cause cause_of(const Scene& scene, const WorldRay& ray, const std::optional<SurfacePoint>& own,
               const std::optional<SurfacePoint>& embree)
{
    if (!own && !embree) return Cause::none;
    const bool    same = own && embree && own->draw == embree->draw && own->triangle == embree->triangle;
    const Meeting a    = own ? meet(scene, *own, ray) : Meeting{.t = double(ray.t_max)},
                  b    = embree ? meet(scene, *embree, ray) : Meeting{.t = double(ray.t_max)};
    if (same) return Cause::none;
    const auto rounding = [](const Meeting& m) { return ulps * m.size_m / std::max(m.sine, 1e-9); };
    if (own && embree && std::abs(a.t - b.t) <= rounding(a) + rounding(b)) return Cause::in_one_place;
    const bool          own_nearer = own && (!embree || a.t < b.t);
    const SurfacePoint& nearer     = own_nearer ? *own : *embree;
    const Meeting&      m          = own_nearer ? a : b;
    if (m.edge_m <= ulps * m.size_m) return Cause::edge;
    if (!(m.sine > 1e-3)) return Cause::edge_on;
    if (std::abs(m.t - double(ray.t_min)) <= rounding(m) || std::abs(m.t - double(ray.t_max)) <= rounding(m))
        return Cause::limit;
    const Material& material = scene.materials[scene.draws[nearer.draw].material];
    if (material.alpha_mask && std::abs(surface_colour(scene, nearer).a - material.alpha_cutoff) < 1.0F / 255)
        return Cause::mask;
    return Cause::wrong;
}

} // namespace

void compare_with_embree(const SceneBvh& embree, const World& world, std::span<const WorldRay> rays,
                         Differences& differences)
{
    const Scene&          scene = embree.scene();
    const WorldTrace      found = trace_world(device(), world, rays);
    std::vector<SceneRay> scene_rays;
    for (const WorldRay& ray : rays) scene_rays.push_back({ray.origin_ws, ray.direction_ws, ray.t_min, ray.t_max});
    std::vector<SceneHit> hits(rays.size());
    embree.intersect(scene_rays, hits);
    EXPECT_GT(found.node_visits, rays.size());
    for (size_t i = 0; i < rays.size(); ++i) {
        const WorldHit& hit = found.hits[i];
        ASSERT_NE(hit.triangle, walk_unfinished);
        std::optional<SurfacePoint> own, theirs;
        if (hit.triangle != no_triangle) own = surface_of(scene, world, hit);
        if (hits[i].met) theirs = hits[i].surface;
        Cause cause = cause_of(scene, rays[i], own, theirs);
        // The distance itself: of the same triangle, and as the walk gives it.
        const Meeting exact = own ? meet(scene, *own, rays[i]) : Meeting{};
        if (own && exact.sine > 1e-3 &&
            std::abs(double(hit.t) - exact.t) > ulps * (exact.t + exact.size_m / exact.sine))
            cause = Cause::wrong;
        ++differences.rays;
        differences.meeting += hits[i].met;
        ++differences.by_cause[static_cast<size_t>(cause)];
        if (cause == Cause::wrong && differences.first_wrong.empty()) {
            const Meeting of_embree = theirs ? meet(scene, *theirs, rays[i]) : Meeting{};
            differences.first_wrong = fmt::format(
                "from ({:.9g}, {:.9g}, {:.9g}) along ({:.9g}, {:.9g}, {:.9g}): t {} on draw {} triangle {}, exactly "
                "{}, "
                "{} m from an edge, sine {}; Embree: t {} on draw {} triangle {}, {} m from an edge, sine {}",
                rays[i].origin_ws.x, rays[i].origin_ws.y, rays[i].origin_ws.z, rays[i].direction_ws.x,
                rays[i].direction_ws.y, rays[i].direction_ws.z, own ? hit.t : -1.0F, own ? int(own->draw) : -1,
                own ? int(own->triangle) : -1, exact.t, exact.edge_m, exact.sine, hits[i].met ? hits[i].t : -1.0,
                theirs ? int(theirs->draw) : -1, theirs ? int(theirs->triangle) : -1, of_embree.edge_m, of_embree.sine);
        }
    }
}

std::vector<WorldRay> random_rays(const Scene& scene, size_t count, uint32_t seed)
{
    glm::vec3 low(1e30F), high(-1e30F);
    for (const Vertex& vertex : scene.vertices) {
        low  = glm::min(low, vertex.position_ws);
        high = glm::max(high, vertex.position_ws);
    }
    std::mt19937                          random(seed);
    std::uniform_real_distribution<float> unit(0, 1), both(-1, 1);
    const auto                            any = [&] { return glm::vec3(both(random), both(random), both(random)); };
    std::vector<WorldRay>                 rays;
    while (rays.size() < count) {
        const float     reach     = rays.size() % 4 == 0 ? 2 : 1;
        const glm::vec3 at        = (low + high) / 2.0F + reach * (high - low) / 2.0F * any();
        glm::vec3       direction = any();
        if (rays.size() % 3 == 0) {
            const size_t first = 3 * (random() % (scene.indices.size() / 3)), k = random() % 3;
            const auto   corner = [&](size_t i) { return scene.vertices[scene.indices[first + i % 3]].position_ws; };
            const float  share  = rays.size() % 2 == 0 ? unit(random) : 0;
            direction           = glm::mix(corner(k), corner(k + 1), share) - at;
        }
        if (glm::length(direction) > 0.1F) rays.push_back({at, 1e-3F, glm::normalize(direction), far_m});
    }
    return rays;
}

} // namespace ssrlab::test
