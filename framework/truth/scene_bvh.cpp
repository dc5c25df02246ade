#include "truth/scene_bvh.h"

#include "core/error.h"

#include <embree3/rtcore.h>

#include <cmath>
#include <deque>
#include <vector>

namespace ssrlab {
namespace {

struct FilteredDraw {
    const Scene* scene;
    uint32_t     draw;
};

glm::dvec3 front_normal_ws(const Scene& scene, const SurfacePoint& point)
{
    const glm::dvec3 a = corner_ws(scene, point, 0);
    return glm::cross(corner_ws(scene, point, 1) - a, corner_ws(scene, point, 2) - a);
}

// Interpolation rounds: an alpha of 1 at all corners may be a bit less between them. Alphas in files differ by 1/255.
constexpr float alpha_rounding = 0x1p-16F;

/// Where the rasteriser would not draw: alpha below the cutoff, and for rays marked so the back of a single-sided material.
void pass_undrawn(const RTCFilterFunctionNArguments* arguments)
{
    const auto& [scene, draw] = *static_cast<const FilteredDraw*>(arguments->geometryUserPtr);
    const Material& material  = scene->materials[scene->draws[draw].material];
    RTCRayN* const  rays      = arguments->ray;
    RTCHitN* const  hits      = arguments->hit;
    const unsigned  n         = arguments->N;
    for (unsigned i = 0; i < n; ++i) {
        if (arguments->valid[i] == 0) continue;
        const SurfacePoint point{draw, RTCHitN_primID(hits, n, i), {RTCHitN_u(hits, n, i), RTCHitN_v(hits, n, i)}};
        const glm::dvec3   direction(RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i));
        const bool         culls = !material.double_sided && RTCRayN_id(rays, n, i) == unsigned(Sides::as_rasterised);
        if ((culls && glm::dot(front_normal_ws(*scene, point), direction) > 0) ||
            (material.alpha_mask && surface_colour(*scene, point).a < material.alpha_cutoff - alpha_rounding)) {
            arguments->valid[i] = 0;
        }
    }
}

void require_valid(const Scene& scene)
{
    for (const Draw& draw : scene.draws) {
        if (draw.index_count % 3 != 0 || size_t(draw.first_index) + draw.index_count > scene.indices.size() ||
            draw.material >= scene.materials.size()) {
            throw_failure("scene '{}': draw '{}' reaches outside the scene's indices or materials", scene.name,
                          draw.name);
        }
    }
    for (const uint32_t index : scene.indices) {
        if (index >= scene.vertices.size()) {
            throw_failure("scene '{}': index {} of {} vertices", scene.name, index, scene.vertices.size());
        }
    }
}

bool finite(glm::dvec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Embree aborts the process on NaN.
RTCRay to_embree(const SceneRay& ray, Sides sides)
{
    RTCRay     result{};
    const bool usable = finite(ray.origin_ws) && finite(ray.direction_ws) &&
                        glm::vec3(ray.direction_ws) != glm::vec3(0) && finite(glm::dvec3(glm::vec3(ray.origin_ws))) &&
                        ray.t_min >= 0 && ray.t_max >= ray.t_min;
    result.dir_z = 1;
    result.tnear = 0;
    result.tfar  = -1; // inactive
    if (!usable) return result;
    result.org_x = float(ray.origin_ws.x);
    result.org_y = float(ray.origin_ws.y);
    result.org_z = float(ray.origin_ws.z);
    result.dir_x = float(ray.direction_ws.x);
    result.dir_y = float(ray.direction_ws.y);
    result.dir_z = float(ray.direction_ws.z);
    result.tnear = float(ray.t_min);
    result.tfar  = float(ray.t_max);
    result.mask  = ~0U;
    result.id    = unsigned(sides);
    return result;
}

SceneHit to_scene_hit(const Scene& scene, const SceneRay& ray, const RTCRayHit& found)
{
    SceneHit hit;
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
    hit.met                = true;
    hit.surface            = {found.hit.geomID, found.hit.primID, {found.hit.u, found.hit.v}};
    hit.normal_ws          = front_normal_ws(scene, hit.surface);
    hit.t                  = double(found.ray.tfar);
    const glm::dvec3 to_a  = corner_ws(scene, hit.surface, 0) - ray.origin_ws;
    const double     exact = glm::dot(hit.normal_ws, to_a) / glm::dot(hit.normal_ws, ray.direction_ws);
    // A degenerate or edge-on triangle has no reliable plane.
    constexpr double plausible = 1e-3;
    if (std::abs(exact - hit.t) <= plausible * hit.t) hit.t = exact;
    return hit;
}

} // namespace

struct SceneBvh::Embree {
    RTCDevice                device = rtcNewDevice("threads=0,set_affinity=0");
    RTCScene                 scene  = rtcNewScene(device);
    std::deque<FilteredDraw> filtered; // stable addresses: Embree keeps pointers

    Embree()                         = default;
    Embree(const Embree&)            = delete;
    Embree& operator=(const Embree&) = delete;
    ~Embree()
    {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }

    void add(const Scene& source, uint32_t draw_index)
    {
        const Draw& draw     = source.draws[draw_index];
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, source.vertices.data(),
                                   offsetof(Vertex, position_ws), sizeof(Vertex), source.vertices.size());
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, source.indices.data(),
                                   draw.first_index * sizeof(uint32_t), 3 * sizeof(uint32_t), draw.index_count / 3);
        const Material& material = source.materials[draw.material];
        rtcSetGeometryUserData(geometry, &filtered.emplace_back(FilteredDraw{&source, draw_index}));
        if (material.alpha_mask) rtcSetGeometryIntersectFilterFunction(geometry, pass_undrawn);
        if (material.alpha_mask || !material.double_sided) rtcSetGeometryOccludedFilterFunction(geometry, pass_undrawn);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, draw_index);
        rtcReleaseGeometry(geometry);
    }
};

SceneBvh::SceneBvh(const Scene& scene) : scene_(&scene), embree_(std::make_unique<Embree>())
{
    require_valid(scene);
    for (uint32_t i = 0; i < scene.draws.size(); ++i) {
        if (scene.draws[i].index_count > 0) embree_->add(scene, i);
    }
    rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(embree_->scene);
    if (const RTCError error = rtcGetDeviceError(embree_->device); error != RTC_ERROR_NONE) {
        throw_failure("scene '{}': Embree could not build its hierarchy (error {})", scene.name, int(error));
    }
}

SceneBvh::SceneBvh(SceneBvh&&) noexcept = default;
SceneBvh::~SceneBvh()                   = default;

void SceneBvh::intersect(std::span<const SceneRay> rays, std::span<SceneHit> hits) const
{
    std::vector<RTCRayHit> work(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) {
        work[i].ray           = to_embree(rays[i], Sides::both);
        work[i].hit           = {};
        work[i].hit.geomID    = RTC_INVALID_GEOMETRY_ID;
        work[i].hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect1M(embree_->scene, &context, work.data(), unsigned(work.size()), sizeof(RTCRayHit));
    for (size_t i = 0; i < rays.size(); ++i) hits[i] = to_scene_hit(*scene_, rays[i], work[i]);
}

void SceneBvh::occluded(std::span<const SceneRay> rays, Sides sides, std::span<uint8_t> occluded) const
{
    std::vector<RTCRay> work(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) work[i] = to_embree(rays[i], sides);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcOccluded1M(embree_->scene, &context, work.data(), unsigned(work.size()), sizeof(RTCRay));
    // Embree marks an occluded ray with tfar = -inf.
    for (size_t i = 0; i < rays.size(); ++i) {
        occluded[i] = std::isinf(work[i].tfar) && work[i].tfar < 0 ? 1 : 0;
    }
}

} // namespace ssrlab
