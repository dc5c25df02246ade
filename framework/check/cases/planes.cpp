// Hard cases, family "planes": pixels that hold planes and solids (docs/reference/hit_contract.md).
#include "check/hard_case.h"
#include "core/plane_gradient.h"

#include <array>
#include <cmath>
#include <random>

namespace ssrlab {
namespace {

constexpr glm::dvec3 point{0, 0, -6};
const glm::dvec3     normals[] = {
        glm::normalize(glm::dvec3(0, 0.9, 0.3)), glm::normalize(glm::dvec3(-0.4, 0.2, 1)), {0, 0, 1}};

TraceSettings with(const std::string& surface, Behind behind)
{
    return {.thickness_m = 1, .max_distance_m = 100, .behind = behind, .surface = surface};
}

std::vector<View> both_views() { return {bench_view({97, 64}), orthographic_view({97, 64}, 8, 0.1, 40)}; }

/// Depth of the plane through `point` at a position on screen: linear there.
double plane_depth(const View& view, glm::dvec3 normal, glm::dvec2 position_px)
{
    const double     far  = distance_to_depth(view, 1);
    const glm::dvec3 at_1 = px_to_vs(view, position_px, far);
    if (view.projection == Projection::orthographic)
        return distance_to_depth(view, -(point.z - (normal.x * at_1.x + normal.y * at_1.y) / normal.z));
    return distance_to_depth(view, glm::dot(point, normal) / glm::dot(at_1, normal));
}

/// t where a ray meets the plane; linear depths meet linearly.
double crossing_t(const View& view, glm::dvec3 normal, const RayInput& ray)
{
    const glm::dvec3 from = ray.origin_px_depth, to = from + ray.delta_px_depth;
    const double     a = from.z - plane_depth(view, normal, glm::dvec2(from)),
                 b     = to.z - plane_depth(view, normal, glm::dvec2(to));
    return a / (a - b);
}

/// Random rays from so many times the plane's distance to so many times.
std::vector<RayInput> rays_through(const View& view, glm::dvec3 normal, double from_share, double to_share)
{
    std::mt19937                           engine(11);
    std::uniform_real_distribution<double> x(1, 96), y(1, 63);
    std::vector<RayInput>                  rays;
    for (int i = 0; i < 6000; ++i) {
        const glm::dvec2 from(x(engine), y(engine)), to(x(engine), y(engine));
        const double     near = plane_depth(view, normal, from), far = plane_depth(view, normal, to);
        if (!(near > 0.001 && near <= 1 && far > 0.001 && far <= 1) || glm::distance(from, to) < 4) continue;
        const double from_m = depth_to_distance(view, near) * from_share,
                     to_m   = depth_to_distance(view, far) * to_share;
        if (std::min(from_m, to_m) < 1.5 * view.near_m || std::max(from_m, to_m) > 35) continue;
        rays.push_back(ray_between(view, {from, from_m}, {to, to_m}));
    }
    return rays;
}

std::vector<Setup> plane_setups(std::span<const TraceSettings> list, double from_share, double to_share)
{
    std::vector<Setup> setups;
    for (const View& view : both_views())
        for (const glm::dvec3& normal : normals)
            for (const TraceSettings& settings : list) {
                Setup setup{fmt::format("{}, normal ({:.2f}, {:.2f}, {:.2f}), {}, {}", view.name, normal.x, normal.y,
                                        normal.z, settings.surface, behind_names[static_cast<size_t>(settings.behind)]),
                            picture_of(view, {plane(point, normal)}), settings,
                            rays_through(view, normal, from_share, to_share)};
                complete_gradients(setup.gbuffer);
                setups.push_back(setup);
            }
    return setups;
}

/// The normal of the one plane in such a picture, as its label was made.
glm::dvec3 normal_of(const Setup& setup)
{
    for (const glm::vec3& normal : setup.gbuffer.normal_vs)
        for (const glm::dvec3& known : normals)
            if (glm::distance(glm::dvec3(normal), known) < 1e-5) return known;
    return {0, 0, 1};
}

bool crosses_in_sight(const Setup& setup, const RayInput& ray, double t)
{
    const glm::dvec2 at = glm::dvec2(ray.origin_px_depth) + t * glm::dvec2(ray.delta_px_depth);
    const glm::dvec2 start(ray.pixel);
    const bool       own = at.x > start.x - 0.1 && at.x < start.x + 1.1 && at.y > start.y - 0.1 && at.y < start.y + 1.1;
    const size_t     x = static_cast<size_t>(at.x), y = static_cast<size_t>(at.y);
    return !own && setup.gbuffer.depth[y * static_cast<size_t>(setup.gbuffer.view.size_px.x) + x] > 0;
}

/// Does the ray cross the plane's tolerance within one pixel? At a border inside it, a ray from below counts as one that enters from the side.
bool crosses_within_a_pixel(const Setup& setup, const RayInput& ray, double t)
{
    const glm::dvec3 from = ray.origin_px_depth, to = from + ray.delta_px_depth;
    const glm::dvec3 normal = normal_of(setup);
    const View&      view   = setup.gbuffer.view;
    const double     change = std::abs((from.z - plane_depth(view, normal, glm::dvec2(from))) -
                                       (to.z - plane_depth(view, normal, glm::dvec2(to))));
    const double     reach  = 3.0 / 1024 / change; // no depth is above 1, and no tolerance above 1/1024
    const auto pixel = [&](double at) { return glm::floor(glm::dvec2(from) + at * glm::dvec2(ray.delta_px_depth)); };
    return pixel(t - reach) == pixel(t + reach);
}

HardCase watertight_plane()
{
    return {.name   = "watertight_plane",
            .breaks = "boxes of neighbouring depths leave gaps on a tilted surface, and a ray slips through: stripes",
            .answer = "A plane fills the image; each ray starts before it and ends behind it. It hits where the two "
                      "linear depths are equal, within what gradients of 8 bits allow.",
            .setups =
                [] {
                    return plane_setups(std::array{with("plane", Behind::stop), with("plane_solid", Behind::hit)}, 0.7,
                                        1.6);
                },
            .expected = [](const Setup& setup, const RayInput& ray) -> std::optional<Expected> {
                const double t = crossing_t(setup.gbuffer.view, normal_of(setup), ray);
                if (!(t > 0 && t < 1) || !crosses_in_sight(setup, ray, t)) return std::nullopt;
                return Expected{.status = TraceStatus::hit};
            }};
}

HardCase plane_from_below()
{
    return {.name   = "plane_from_below",
            .breaks = "a ray that comes from behind a surface takes the colour of its front",
            .answer = "Each ray starts behind the plane and ends before it: stopped, passed or hit, as `behind` says.",
            .setups =
                [] {
                    return plane_setups(std::array{with("plane", Behind::stop), with("plane", Behind::pass),
                                                   with("plane", Behind::hit)},
                                        1.6, 0.7);
                },
            .expected = [](const Setup& setup, const RayInput& ray) -> std::optional<Expected> {
                const double t = crossing_t(setup.gbuffer.view, normal_of(setup), ray);
                if (!(t > 0 && t < 1) || !crosses_in_sight(setup, ray, t) || !crosses_within_a_pixel(setup, ray, t))
                    return std::nullopt;
                const Behind behind = setup.settings.behind;
                return Expected{.status = behind == Behind::hit    ? TraceStatus::hit
                                          : behind == Behind::pass ? TraceStatus::facing_away
                                                                   : TraceStatus::stopped};
            }};
}

HardCase mirror_alone()
{
    return {.name   = "mirror_alone",
            .breaks = "a mirror hits itself in the next pixel, unless its rays start at an offset",
            .answer = "A plane fills the image and every pixel reflects. No ray comes back to it.",
            .setups =
                [] {
                    std::vector<Setup> setups = plane_setups(
                        std::array{with("plane", Behind::hit), with("plane_solid", Behind::stop)}, 0.7, 1.6);
                    for (Setup& setup : setups) setup.rays.clear();
                    return setups;
                },
            .expected = [](const Setup&, const RayInput& ray) -> std::optional<Expected> {
                return Expected{.status = ray.end_status};
            }};
}

HardCase solid_from_its_side()
{
    return {
        .name   = "solid_from_its_side",
        .breaks = "a ray goes on inside a wall as if the wall were as thin as paper",
        .answer =
            "Right of column 48 a wall at Z = 4, solid to Z = 6; left of it nothing. Level rays at Z = 5.2 run "
            "into its side: stopped at its first column, through with `plane`. At Z = 7 they pass behind it, but for "
            "`plane_infinite`.",
        .setups =
            [] {
                std::vector<Setup> setups;
                for (const std::string surface : {"plane", "plane_solid", "plane_infinite"}) {
                    Setup setup{surface,
                                picture_of(bench_view({97, 64}), [](glm::ivec2 p) { return p.x > 48 ? 4.0 : 0.0; }),
                                with(surface, Behind::stop),
                                {}};
                    complete_gradients(setup.gbuffer);
                    for (const float depth : setup.gbuffer.depth)
                        setup.gbuffer.solid_back.push_back(
                            depth > 0 ? static_cast<float>(distance_to_depth(setup.gbuffer.view, 6)) : 0);
                    for (int y = 0; y < 64; ++y)
                        for (const double z : {5.2, 7.0})
                            setup.rays.push_back(level_ray(setup.gbuffer.view, {10.5, y + 0.5}, {80, 0}, z));
                    setups.push_back(setup);
                }
                return setups;
            },
        .expected = [](const Setup& setup, const RayInput& ray) -> std::optional<Expected> {
            const bool level_5 = depth_to_distance(setup.gbuffer.view, ray.origin_px_depth.z) < 6;
            const bool stops =
                setup.settings.surface == "plane_infinite" || (level_5 && setup.settings.surface == "plane_solid");
            if (!stops) return Expected{.status = ray.end_status};
            return Expected{.status = TraceStatus::stopped, .pixel = glm::ivec2(49, ray.pixel.y), .t = 38.5 / 80};
        }};
}

HardCase no_usable_plane()
{
    return {.name   = "no_usable_plane",
            .breaks = "a normal of zero or NaN makes a plane of NaN, which nothing meets or everything does",
            .answer = "The pixel holds the box of the run's thickness (1 m): level rays hit the wall at Z = 4 at 4.5 m "
                      "and pass it at 5.5 m.",
            .setups =
                [] {
                    Setup setup{{},
                                picture_of(bench_view({97, 64}), [](glm::ivec2 p) { return p.x > 48 ? 4.0 : 0.0; }),
                                with("plane", Behind::stop),
                                {}};
                    for (size_t i = 0; i < setup.gbuffer.normal_vs.size(); ++i)
                        setup.gbuffer.normal_vs[i] = i % 2 == 0 ? glm::vec3(0) : glm::vec3(NAN, 0, 1);
                    complete_gradients(setup.gbuffer);
                    for (int y = 0; y < 64; ++y)
                        for (const double z : {4.5, 5.5})
                            setup.rays.push_back(level_ray(setup.gbuffer.view, {10.5, y + 0.5}, {80, 0}, z));
                    return std::vector{setup};
                },
            .expected = [](const Setup& setup, const RayInput& ray) -> std::optional<Expected> {
                if (depth_to_distance(setup.gbuffer.view, ray.origin_px_depth.z) > 5)
                    return Expected{.status = ray.end_status};
                return Expected{.pixel = glm::ivec2(49, ray.pixel.y), .t = 38.5 / 80};
            }};
}

HardCase wall_behind_a_wall()
{
    return {.name   = "wall_behind_a_wall",
            .breaks = "what stands behind something is not there, or the ray takes the surface in front of it",
            .answer = "Right of column 48 a wall at Z = 4, and in the layer behind it one at Z = 6, each 1 m thick. "
                      "Level rays at Z = 4.5 hit the first, at Z = 6.5 the second, at 5.5 and 7.5 neither.",
            .setups =
                [] {
                    const auto wall_at = [](double distance_m) {
                        GBufferImage picture =
                            picture_of(bench_view({97, 64}), [=](glm::ivec2 p) { return p.x > 48 ? distance_m : 0.0; });
                        complete_gradients(picture);
                        return picture;
                    };
                    Setup setup{{}, wall_at(4), with("box", Behind::hit), {}};
                    setup.settings.layers = 2;
                    setup.gbuffer.layers.push_back(wall_at(6));
                    for (int y = 0; y < 64; ++y)
                        for (const double z : {4.5, 5.5, 6.5, 7.5})
                            setup.rays.push_back(level_ray(setup.gbuffer.view, {10.5, y + 0.5}, {80, 0}, z));
                    return std::vector{setup};
                },
            .expected = [](const Setup& setup, const RayInput& ray) -> std::optional<Expected> {
                const double z = depth_to_distance(setup.gbuffer.view, ray.origin_px_depth.z);
                if (std::lround(z * 2) % 4 == 3) return Expected{.status = ray.end_status};
                return Expected{.pixel = glm::ivec2(49, ray.pixel.y), .t = 38.5 / 80};
            }};
}

} // namespace

CaseFamily plane_cases()
{
    return {"planes",
            {watertight_plane(), plane_from_below(), mirror_alone(), solid_from_its_side(), no_usable_plane(),
             wall_behind_a_wall()}};
}

} // namespace ssrlab
