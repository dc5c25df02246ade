#include "truth/bounced_light.h"

#include "core/parallel_rows.h"
#include "truth/r2_sequence.h"
#include "truth/scene_truth.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ssrlab {
namespace {

constexpr double pi = std::numbers::pi;

glm::dvec2 even(int k) { return r2_point(k, glm::dvec2(0.5)); }

/// T. Duff et al. 2017, "Building an Orthonormal Basis, Revisited", JCGT 6(1).
glm::dmat3 frame_about(glm::dvec3 n)
{
    const double sign = std::copysign(1.0, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
    return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

/// By the cosine about +z. Neighbours in the list are neighbours on the hemisphere, which Embree traces together.
std::vector<glm::dvec3> hemisphere(int count)
{
    std::vector<glm::dvec2> numbers;
    for (int k = 0; k < count; ++k) numbers.push_back(even(k));
    const double rings = std::sqrt(count / 4.0);
    std::ranges::sort(numbers, {}, [&](glm::dvec2 u) { return std::pair(std::floor(u.x * rings), u.y); });
    std::vector<glm::dvec3> directions;
    for (const glm::dvec2& u : numbers) {
        const double radius = std::sqrt(u.x), angle = 2 * pi * u.y;
        directions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), std::sqrt(1 - u.x));
    }
    return directions;
}

struct LightPoint {
    glm::dvec3 point_ws{0}, normal_ws{0};
    glm::vec3  radiance{0};
    double     density = 0; // of points, 1/m2
};

/// Points on what glows, the denser the brighter it is.
class Emitters {
public:
    explicit Emitters(const Scene& scene) : scene_(scene)
    {
        for (uint32_t d = 0; d < scene.draws.size(); ++d) {
            const float brightness = brightness_of(d);
            for (uint32_t t = 0; brightness > 0 && 3 * t < scene.draws[d].index_count; ++t) {
                power_ += double(brightness) * glm::length(cross_of({d, t})) / 2;
                triangles_.push_back({d, t});
                sums_.push_back(power_);
            }
        }
    }

    bool none() const { return !(power_ > 0); }

    double density(uint32_t draw) const { return power_ > 0 ? double(brightness_of(draw)) / power_ : 0; }

    std::vector<LightPoint> points(int count) const
    {
        std::vector<LightPoint> points;
        for (int k = 0; k < count && !none(); ++k) {
            const auto   place = std::ranges::upper_bound(sums_, (k + 0.5) / count * power_) - sums_.begin();
            SurfacePoint point = triangles_[std::min(size_t(place), triangles_.size() - 1)];
            glm::dvec2   u     = even(k);
            if (u.x + u.y > 1) u = 1.0 - u;
            point.barycentric        = u;
            const glm::dvec3 a       = corner_ws(scene_, point, 0);
            const glm::dvec3 edges_u = corner_ws(scene_, point, 1) - a, edges_v = corner_ws(scene_, point, 2) - a;
            points.push_back({a + u.x * edges_u + u.y * edges_v, glm::normalize(cross_of(point)),
                              surface_material(scene_, point).emissive, density(point.draw)});
        }
        return points;
    }

private:
    float brightness_of(uint32_t draw) const
    {
        const glm::vec3 emissive = scene_.materials[scene_.draws[draw].material].emissive;
        return emissive.r + emissive.g + emissive.b;
    }

    glm::dvec3 cross_of(const SurfacePoint& point) const
    {
        const glm::dvec3 a = corner_ws(scene_, point, 0);
        return glm::cross(corner_ws(scene_, point, 1) - a, corner_ws(scene_, point, 2) - a);
    }

    const Scene&              scene_;
    std::vector<SurfacePoint> triangles_;
    std::vector<double>       sums_; // of brightness and area, up to each triangle
    double                    power_ = 0;
};

/// What all vertices ask in one bounce.
struct Gathering {
    std::vector<glm::dvec3> directions;
    std::vector<LightPoint> points;
};

/// One side of the surface at a vertex, where rays begin.
struct Receiver {
    glm::dvec3 point_ws{0}, normal_ws{0};
    double     lift_m = 0; // above the surface; what lies nearer than this is not met
};

glm::dvec3 lifted(const Receiver& at) { return at.point_ws + at.lift_m * at.normal_ws; }

class Gatherer {
public:
    Gatherer(const Scene& scene, unsigned threads)
        : scene_(scene), threads_(threads), bvh_(scene), emitters_(scene), inner_ws_(scene.vertices.size()),
          sides_(scene.vertices.size(), 1), sent_(scene.vertices.size(), glm::vec3(0))
    {
        std::vector<int>  triangles(scene.vertices.size());
        std::vector<bool> double_sided(scene.vertices.size());
        for (const Draw& draw : scene.draws) {
            const uint32_t* corners = scene.indices.data() + draw.first_index;
            for (uint32_t i = 0; i < draw.index_count; ++i) {
                for (uint32_t k = i - i % 3; k < i - i % 3 + 3; ++k)
                    inner_ws_[corners[i]] += glm::dvec3(scene.vertices[corners[k]].position_ws) / 3.0;
                ++triangles[corners[i]];
                double_sided[corners[i]] = scene.materials[draw.material].double_sided;
            }
        }
        for (size_t v = 0; v < triangles.size(); ++v) inner_ws_[v] /= std::max(triangles[v], 1);
        const std::vector<glm::dvec3> probes = hemisphere(16);
        const std::vector<glm::vec3>  backs  = for_each_vertex([&](size_t v) {
            Receiver front = receiver(v), back = front;
            back.normal_ws = -back.normal_ws;
            return glm::vec3(double_sided[v] && openness(probes, back) > openness(probes, front));
        });
        for (size_t v = 0; v < sides_.size(); ++v) sides_[v] = backs[v].x > 0 ? -1 : 1;
    }

    std::vector<glm::vec3> run()
    {
        const Bake&                  bake   = *scene_.bake;
        const std::vector<glm::vec3> direct = for_each_vertex([&](size_t v) {
            const Receiver at = receiver(v);
            const LitPoint lit{at.point_ws, lifted(at), at.normal_ws, at.lift_m};
            return direct_irradiance(bvh_, scene_, lit) * float(1 / pi);
        });
        std::vector<glm::vec3>       bounced(direct.size(), glm::vec3(0));
        for (int bounce = 0; bounce < bake.bounces; ++bounce) {
            for (size_t v = 0; v < sent_.size(); ++v) sent_[v] = direct[v] + scene_.ambient + bounced[v];
            // Noise of all but the last is averaged by the next.
            const int       paths = bounce + 1 < bake.bounces ? std::max(bake.paths / 8, 16) : bake.paths;
            const Gathering asked{hemisphere(paths), emitters_.points(paths)};
            bounced = for_each_vertex([&](size_t v) { return gather(asked, receiver(v)); });
        }
        return bounced;
    }

private:
    template <typename LightAt> std::vector<glm::vec3> for_each_vertex(const LightAt& light_at) const
    {
        constexpr size_t       chunk = 64;
        std::vector<glm::vec3> light(scene_.vertices.size());
        parallel_rows(int((light.size() + chunk - 1) / chunk), threads_, [&](int row) {
            for (size_t v = size_t(row) * chunk; v < std::min((size_t(row) + 1) * chunk, light.size()); ++v)
                light[v] = light_at(v);
        });
        return light;
    }

    /// A little inside its triangles: at their border, a wall that stands there would be met or not by rounding.
    Receiver receiver(size_t v) const
    {
        constexpr double inward = 0.05;
        const glm::dvec3 at     = glm::mix(glm::dvec3(scene_.vertices[v].position_ws), inner_ws_[v], inward);
        const double     far_m  = std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)});
        return {at, sides_[v] * glm::normalize(glm::dvec3(scene_.vertices[v].normal_ws)),
                std::max(1e-3 * scene_.bake->edge_m, 1e-6 * far_m)};
    }

    /// 0 to 1: how far rays get, up to the sky if it shines. Inside a solid, or between its two skins, they end soon.
    double openness(const std::vector<glm::dvec3>& directions, const Receiver& at) const
    {
        const std::vector<SceneRay> rays = rays_from(directions, at);
        const std::vector<SceneHit> hits = hits_of(rays);
        double                      sum  = 0;
        for (size_t k = 0; k < rays.size(); ++k) {
            if (hits[k].met)
                sum += hits[k].t / (hits[k].t + 4 * scene_.bake->edge_m);
            else
                sum += sky_radiance(scene_, rays[k].direction_ws) == glm::vec3(0) ? 0 : 1;
        }
        return sum / double(rays.size());
    }

    static std::vector<SceneRay> rays_from(const std::vector<glm::dvec3>& directions, const Receiver& at)
    {
        const glm::dmat3      frame = frame_about(at.normal_ws);
        std::vector<SceneRay> rays;
        for (const glm::dvec3& direction : directions)
            rays.push_back({lifted(at), frame * direction, at.lift_m, std::numeric_limits<double>::infinity()});
        return rays;
    }

    std::vector<SceneHit> hits_of(const std::vector<SceneRay>& rays) const
    {
        std::vector<SceneHit> hits(rays.size());
        bvh_.intersect(rays, hits);
        return hits;
    }

    /// The mean of radiance by the cosine.
    glm::vec3 gather(const Gathering& asked, const Receiver& at) const
    {
        const std::vector<SceneRay> rays = rays_from(asked.directions, at);
        const std::vector<SceneHit> hits = hits_of(rays);
        glm::vec3                   light(0);
        for (size_t k = 0; k < rays.size(); ++k) light += arriving(rays[k], hits[k], asked.directions[k].z);
        return (light + from_points(asked, at)) / float(rays.size());
    }

    glm::vec3 arriving(const SceneRay& ray, const SceneHit& hit, double cosine) const
    {
        if (!hit.met) return sky_radiance(scene_, ray.direction_ws);
        const SurfacePoint& met  = hit.surface;
        const Draw&         draw = scene_.draws[met.draw];
        glm::vec3           sent(0);
        for (uint32_t i : {0U, 1U, 2U}) {
            const double weight = i == 0   ? 1 - met.barycentric.x - met.barycentric.y
                                  : i == 1 ? met.barycentric.x
                                           : met.barycentric.y;
            sent += float(weight) * sent_[scene_.indices[draw.first_index + 3 * met.triangle + i]];
        }
        sent *= glm::vec3(surface_colour(scene_, met));
        if (scene_.materials[draw.material].emissive == glm::vec3(0)) return sent;
        const double facing   = std::abs(glm::dot(glm::normalize(hit.normal_ws), ray.direction_ws));
        const double by_ray   = cosine / pi * facing; // both densities times `facing`
        const double by_point = emitters_.density(met.draw) * hit.t * hit.t;
        return sent + surface_material(scene_, met).emissive * float(by_ray / (by_ray + by_point));
    }

    /// What the points on emitters send, as a sum of as many samples.
    glm::vec3 from_points(const Gathering& asked, const Receiver& at) const
    {
        const glm::dvec3       from_ws = lifted(at);
        std::vector<SceneRay>  rays;
        std::vector<glm::vec3> light;
        for (const LightPoint& point : asked.points) {
            const glm::dvec3 way      = point.point_ws - from_ws;
            const double     length_m = glm::length(way), cosine = glm::dot(way, at.normal_ws) / length_m,
                         facing = std::abs(glm::dot(way, point.normal_ws)) / length_m;
            if (!(cosine > 0) || !(facing > 0)) continue;
            const double by_ray = cosine / pi * facing, by_point = point.density * length_m * length_m;
            light.push_back(point.radiance * float(by_ray / (by_ray + by_point)));
            rays.push_back({from_ws, way, at.lift_m / length_m, 1 - 1e-4});
        }
        std::vector<uint8_t> blocked(rays.size());
        bvh_.occluded(rays, Sides::both, blocked);
        glm::vec3 reached(0);
        for (size_t k = 0; k < rays.size(); ++k)
            if (blocked[k] == 0) reached += light[k];
        return reached;
    }

    const Scene&            scene_;
    unsigned                threads_;
    SceneBvh                bvh_;
    Emitters                emitters_;
    std::vector<glm::dvec3> inner_ws_; // of each vertex: the middle of its triangles' middles
    std::vector<double>     sides_;    // likewise: -1 where the back of a double-sided material receives
    std::vector<glm::vec3>  sent_;     // likewise, by a white diffuse surface
};

} // namespace

std::vector<glm::vec3> bounced_light(const Scene& scene, unsigned threads) { return Gatherer(scene, threads).run(); }

} // namespace ssrlab
