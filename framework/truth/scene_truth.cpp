#include "truth/scene_truth.h"

#include "core/error.h"
#include "truth/parallel_rows.h"
#include "truth/screen_ray.h"

#include <cmath>
#include <limits>

namespace ssrlab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The camera as the occlusion rays need it.
struct Eye {
    const View& view;
    glm::dmat4  view_to_world;

    explicit Eye(const View& v) : view(v), view_to_world(glm::inverse(v.world_to_view)) {}

    glm::dvec3 point_to_ws(glm::dvec3 point_vs) const { return glm::dvec3(view_to_world * glm::dvec4(point_vs, 1)); }
    glm::dvec3 direction_to_ws(glm::dvec3 direction_vs) const { return glm::dmat3(view_to_world) * direction_vs; }

    /// From where the camera looks at a point; t = 1 is the point.
    glm::dvec3 origin_vs(glm::dvec3 point_vs) const
    {
        return view.projection == Projection::perspective ? glm::dvec3(0) : glm::dvec3(point_vs.x, point_vs.y, 0);
    }

    SceneRay ray_to(glm::dvec3 point_vs) const
    {
        const glm::dvec3 origin = origin_vs(point_vs);
        return {point_to_ws(origin), direction_to_ws(point_vs - origin), view.near_m / -point_vs.z,
                1 - visibility_tolerance};
    }
};

bool inside_image(const View& view, glm::dvec2 point_px)
{
    return point_px.x >= 0 && point_px.y >= 0 && point_px.x < view.size_px.x && point_px.y < view.size_px.y;
}

/// Fills one row of the truth; the vectors live as long as the row.
class Row {
public:
    Row(const SceneBvh& bvh, const Scene& scene, const GBufferImage& gbuffer, const TraceSettings& settings,
        SceneTruth& truth)
        : m_bvh(bvh), m_scene(scene), m_gbuffer(gbuffer), m_settings(settings), m_truth(truth), m_eye(gbuffer.view)
    {
    }

    void fill(int y)
    {
        make_rays(y);
        m_hits.resize(m_rays.size());
        m_bvh.intersect(m_rays, m_hits);
        m_candidates.clear();
        m_eye_rays.clear();
        for (size_t k = 0; k < m_rays.size(); ++k) {
            if (classify(k) == TruthClass::visible) {
                m_candidates.push_back(k);
                m_eye_rays.push_back(m_eye.ray_to(m_truth.point_vs[m_pixels[k]]));
            }
        }
        m_blocked.resize(m_eye_rays.size());
        m_bvh.occluded(m_eye_rays, Sides::as_rasterised, m_blocked);
        for (size_t c = 0; c < m_candidates.size(); ++c) {
            if (m_blocked[c] != 0) m_truth.cls[m_pixels[m_candidates[c]]] = TruthClass::hidden;
        }
        for (size_t k = 0; k < m_rays.size(); ++k) m_truth.radiance[m_pixels[k]] = radiance(k);
    }

private:
    void make_rays(int y)
    {
        m_rays.clear();
        m_pixels.clear();
        const int width = m_gbuffer.view.size_px.x;
        for (int x = 0; x < width; ++x) {
            if (!reflects(m_gbuffer, {x, y})) continue;
            const glm::dvec3 point_vs = pixel_point_vs(m_gbuffer, {x, y});
            const double     start_m  = self_hit_share * glm::length(point_vs - m_eye.origin_vs(point_vs));
            m_rays.push_back({m_eye.point_to_ws(point_vs),
                              m_eye.direction_to_ws(mirror_direction_vs(m_gbuffer, {x, y})), start_m, infinity});
            m_pixels.push_back(size_t(y) * size_t(width) + size_t(x));
        }
    }

    /// Everything but the occlusion ray, which is sent only for what comes back as visible.
    TruthClass classify(size_t k)
    {
        const SceneRay& ray   = m_rays[k];
        const SceneHit& hit   = m_hits[k];
        const size_t    i     = m_pixels[k];
        const auto      set   = [&](TruthClass cls) { return m_truth.cls[i] = cls; };
        m_truth.distance_m[i] = hit.met ? hit.t : infinity;
        if (!hit.met) return set(TruthClass::sky);

        const View&      view = m_gbuffer.view;
        const glm::dvec3 point_vs =
            glm::dvec3(view.world_to_view * glm::dvec4(ray.origin_ws + hit.t * ray.direction_ws, 1));
        const bool in_front = -point_vs.z >= view.near_m;
        m_truth.point_vs[i] = point_vs;
        if (in_front) m_truth.point_px[i] = glm::dvec2(vs_to_px(view, point_vs));
        if (hit.t > m_settings.max_distance_m) return set(TruthClass::beyond);
        if (!in_front) return set(TruthClass::behind_camera);
        if (!inside_image(view, m_truth.point_px[i])) return set(TruthClass::off_screen);
        const glm::dvec3 sight_ws     = m_eye.direction_to_ws(point_vs - m_eye.origin_vs(point_vs));
        const bool       camera_front = glm::dot(hit.normal_ws, sight_ws) < 0;
        const bool       ray_front    = glm::dot(hit.normal_ws, ray.direction_ws) < 0;
        const bool       drawn = ray_front || m_scene.materials[m_scene.draws[hit.surface.draw].material].double_sided;
        return set(camera_front == ray_front && drawn ? TruthClass::visible : TruthClass::facing_away);
    }

    glm::vec3 radiance(size_t k) const
    {
        const size_t i = m_pixels[k];
        if (m_truth.cls[i] == TruthClass::sky) return m_scene.background;
        if (m_truth.cls[i] == TruthClass::visible) {
            const glm::ivec2 pixel(m_truth.point_px[i]);
            return m_gbuffer.radiance[size_t(pixel.y) * size_t(m_gbuffer.view.size_px.x) + size_t(pixel.x)];
        }
        const SceneRay& ray = m_rays[k];
        return shade_point(m_bvh, m_scene, m_hits[k], ray.origin_ws + m_hits[k].t * ray.direction_ws, ray.direction_ws);
    }

    const SceneBvh&       m_bvh;
    const Scene&          m_scene;
    const GBufferImage&   m_gbuffer;
    const TraceSettings&  m_settings;
    SceneTruth&           m_truth;
    Eye                   m_eye;
    std::vector<SceneRay> m_rays, m_eye_rays;
    std::vector<SceneHit> m_hits;
    std::vector<size_t>   m_pixels, m_candidates;
    std::vector<uint8_t>  m_blocked;
};

} // namespace

SceneTruth empty_scene_truth(glm::ivec2 size_px)
{
    const size_t count = size_t(size_px.x) * size_t(size_px.y);
    SceneTruth   truth;
    truth.size_px = size_px;
    truth.cls.resize(count);
    truth.point_vs.resize(count);
    truth.point_px.resize(count);
    truth.distance_m.resize(count);
    truth.radiance.resize(count);
    return truth;
}

SceneTruth scene_truth(const SceneBvh& bvh, const Scene& scene, const GBufferImage& gbuffer,
                       const TraceSettings& settings, unsigned threads)
{
    require_complete(gbuffer);
    const size_t count = gbuffer.depth.size();
    if (gbuffer.radiance.size() != count) {
        throw_failure("G-buffer of view '{}': expected {} values of radiance, found {}", gbuffer.view.name, count,
                      gbuffer.radiance.size());
    }
    SceneTruth truth = empty_scene_truth(gbuffer.view.size_px);
    parallel_rows(truth.size_px.y, threads, [&](int y) { Row(bvh, scene, gbuffer, settings, truth).fill(y); });
    return truth;
}

} // namespace ssrlab
