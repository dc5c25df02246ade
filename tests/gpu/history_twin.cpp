// Where reflections were in the frame before and what their history becomes, pixel by pixel against the same on the host, in double precision and from
// the scene's own motion.
#include "core/pixel_index.h"
#include "core/plane_gradient.h"
#include "gpu/passes.h"
#include "gpu/sequence_frames.h"

namespace ssrlab::test {
namespace {

constexpr glm::ivec2 size_px{113, 71};
constexpr double     not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double     factor       = 0.1; // of the strategies with parallax

/// Moving boxes over a mirror that turns. The camera was a little farther left, or so far ahead that much of what it sees now was behind it.
Scene moving_scene(Projection projection, bool was_ahead)
{
    Scene scene = load_scene("builtin:moving_boxes");
    for (Draw& draw : scene.draws)
        if (scene.materials[draw.material].metallic > 0)
            draw.motion = {.turn_deg = {0.5, 0, 1.5}, .pivot_ws = {0, -1, -4}};
    std::vector<Camera> cameras = {find_camera(scene, "default"), find_camera(scene, "default")};
    for (Camera& camera : cameras) {
        camera.projection = projection;
        camera.height_m   = 5;
        camera.far_m      = 40;
        camera.target_ws  = {0.2, -0.9, -6};
    }
    cameras[0].position_ws = {-0.3, 0.9, 1.5};
    cameras[1].position_ws = {0.1, 1.1, 1.2};
    if (was_ahead) {
        cameras[0].position_ws = {0.1, 0.4, -7};
        cameras[0].target_ws   = {0.2, -0.9, -14};
    }
    scene.paths = {{"path", cameras, 1}};
    return scene;
}

/// What the passes know of the frame before.
struct Before {
    View                    view; // without jitter
    glm::dvec2              jitter_px, now_jitter_px;
    std::vector<glm::dmat4> to_previous_vs; // by object
    std::vector<float>      depth;
    std::vector<uint32_t>   gradient;
    std::vector<glm::vec4>  normal, reflection, facts;
};

bool inside(glm::dvec2 px) { return px.x >= 0 && px.y >= 0 && px.x < size_px.x && px.y < size_px.y; }

/// On its pixel's plane, but for an extrapolation to less than half or more than twice.
double depth_on_plane(double depth, uint32_t gradient, glm::dvec2 from_centre_px)
{
    const double there = depth + glm::dot(glm::dvec2(unpack_gradient(gradient)), from_centre_px);
    return there >= depth / 2 && there <= 2 * depth ? there : depth;
}

/// Whether two answers are equally right: a place lies so near to the border of its pixel that rounding decides.
bool near_border(glm::dvec2 px)
{
    const glm::dvec2 off = glm::abs(px - glm::round(px));
    return std::min(off.x, off.y) < 0.01; // vector_error_px
}

double previous_depth(const Before& before, glm::dvec2 px)
{
    const glm::dvec2 drawn = px + before.jitter_px;
    if (!inside(drawn)) return 0;
    const glm::ivec2 pixel(drawn);
    const size_t     i = pixel_index(pixel, size_px);
    return depth_on_plane(double(before.depth[i]), before.gradient[i], drawn - glm::dvec2(pixel) - 0.5);
}

/// What a pixel's ray tells: points in both view spaces, positions and motions without jitter.
struct Told {
    glm::dvec3 incidence_pvs, hit_pvs, normal_pvs;
    glm::dvec2 incidence_px, incidence_motion_px, hit_px, hit_motion_px;
    double     length_m;
};

/// In the previous view; NaN behind it.
glm::dvec2 seen_px(const Before& before, glm::dvec3 position_pvs)
{
    if (before.view.projection == Projection::perspective && position_pvs.z >= 0) return glm::dvec2(not_a_number);
    return glm::dvec2(vs_to_px(before.view, position_pvs));
}

/// Where the eye sees a point in the plane through `on_plane`: its mirror image. NaN: eye and point lie on two sides. Nothing: rounding says on which.
std::optional<glm::dvec2> mirrored_px(const Before& before, glm::dvec3 on_plane, glm::dvec3 normal, glm::dvec3 point)
{
    const double eye = glm::dot(normal, -on_plane), height = glm::dot(normal, point - on_plane);
    if (std::min(std::abs(eye), std::abs(height)) < 1e-3) return std::nullopt;
    if (eye * height <= 0) return glm::dvec2(not_a_number);
    const glm::dvec3 image = point - 2 * height * normal;
    // Close to the eye's plane it is seen far away, and rounding says how far.
    if (before.view.projection == Projection::perspective && std::abs(image.z) < 1) return std::nullopt;
    return seen_px(before, image);
}

glm::dvec2 shortest(std::initializer_list<glm::dvec2> vectors)
{
    glm::dvec2 best(not_a_number);
    for (const glm::dvec2& v : vectors)
        if (!std::isnan(v.x) && !(glm::length(best) <= glm::length(v))) best = v;
    return best;
}

/// By a strategy, the place; nothing where rounding decides.
std::optional<glm::dvec2> placed(const std::string& id, const Before& before, const Told& told)
{
    const double parallax = std::clamp(1 - told.length_m * factor, 0.0, 1.0);
    const auto   moved    = [&](glm::dvec2 by_px) { return told.incidence_px + by_px; };
    if (id == "surface") return moved(told.incidence_motion_px);
    if (id == "hit") return moved(told.hit_motion_px);
    if (id == "surface_parallax") return moved(told.incidence_motion_px * parallax);
    if (id == "hit_parallax") return moved(told.hit_motion_px * parallax);
    if (id == "smallest")
        return moved(shortest({told.incidence_motion_px, told.hit_motion_px, told.incidence_motion_px * parallax,
                               told.hit_motion_px * parallax}));
    if (id == "carried_plane") return mirrored_px(before, told.incidence_pvs, told.normal_pvs, told.hit_pvs);
    glm::dvec3 points[2];
    for (const int i : {0, 1}) {
        const glm::dvec2 px = i == 0 ? told.incidence_px + told.incidence_motion_px : told.hit_px + told.hit_motion_px;
        if (std::isnan(px.x)) return px;
        if (near_border(px + before.jitter_px)) return std::nullopt;
        const double depth = previous_depth(before, px);
        if (depth <= 0) return glm::dvec2(not_a_number);
        points[i] = px_to_vs(before.view, px, depth);
    }
    return mirrored_px(before, points[0], told.normal_pvs, points[1]);
}

glm::dvec3 turned(const glm::dmat4& matrix, glm::dvec3 direction) { return glm::dmat3(matrix) * direction; }
glm::dvec3 carried(const glm::dmat4& matrix, glm::dvec3 position)
{
    return glm::dvec3(matrix * glm::dvec4(position, 1));
}

struct Frame {
    GBufferImage                  image;
    std::vector<uint32_t>         gradient;
    Before                        before;
    std::vector<PackedRay<float>> rays;
    std::vector<PackedHit<float>> hits;
    std::vector<glm::vec4>        reprojected, kept_reflection, kept_facts;
    Reflection                    own, result;
    std::vector<uint32_t>         blocks;

    std::array<uint32_t, HISTORY_COUNTS> counted{}; // by the device
};

Told told_by(const Frame& frame, size_t ray, double ray_offset_m)
{
    const PackedRay<float>& listed = frame.rays[ray];
    const PackedHit<float>& hit    = frame.hits[ray];
    const Before&           before = frame.before;
    const glm::ivec2        pixel = unpack_pixel(listed.pixel), met = unpack_pixel(hit.pixel);
    const size_t            i = pixel_index(pixel, size_px), h = pixel_index(met, size_px);
    const int               layer = unpack_layer(hit.pixel);
    const glm::dvec3        point = glm::dvec3(listed.origin) + glm::dvec3(listed.delta) * double(hit.t);
    // A ray that starts off its surface does not say where that is: the pixel's centre does.
    const glm::dvec3 start        = ray_offset_m > 0 ? glm::dvec3(glm::dvec2(pixel) + 0.5, double(frame.image.depth[i]))
                                                     : glm::dvec3(listed.origin);
    const double     met_depth    = layer > 0 ? point.z
                                              : depth_on_plane(double(frame.image.depth[h]), frame.gradient[h],
                                                               glm::dvec2(point) - glm::dvec2(met) - 0.5);
    const glm::dvec3 incidence_vs = px_to_vs(frame.image.view, glm::dvec2(start), start.z),
                     hit_vs       = px_to_vs(frame.image.view, glm::dvec2(point), met_depth);
    const uint32_t met_object =
        layer > 0 ? frame.image.layers.at(size_t(layer - 1)).object_id[h] : frame.image.object_id[h];
    const glm::dmat4 &reflector = before.to_previous_vs[frame.image.object_id[i]],
                     &object    = before.to_previous_vs[met_object];
    Told told;
    told.incidence_pvs       = carried(reflector, incidence_vs);
    told.hit_pvs             = carried(object, hit_vs);
    told.normal_pvs          = turned(reflector, glm::normalize(glm::dvec3(frame.image.normal_vs[i])));
    told.incidence_px        = glm::dvec2(start) - before.now_jitter_px;
    told.hit_px              = glm::dvec2(point) - before.now_jitter_px;
    told.incidence_motion_px = seen_px(before, told.incidence_pvs) - told.incidence_px;
    told.hit_motion_px       = seen_px(before, told.hit_pvs) - told.hit_px;
    told.length_m            = glm::distance(incidence_vs, hit_vs);
    return told;
}

/// The second frame of the path; `change` may change what the first one left.
Frame second_frame(Projection projection, const ParameterValues& passes, TraceSettings trace,
                   const std::function<void(FrameHistory&)>& change = {}, bool was_ahead = false)
{
    const Scene   scene            = moving_scene(projection, was_ahead);
    FrameSettings settings         = sequence_settings(passes);
    settings.trace                 = trace;
    const FrameHistoryPtr history  = make_history(device(), size_px);
    const auto            prepared = [&](const SequencePicture& picture, const FrameHistoryPtr& with) {
        auto run = prepared_frame(picture.buffers, technique("dda"), values_of(technique("dda")), settings, with);
        run_frame(device(), *run);
        return run;
    };
    keep_history(device(), *prepared(picture_at(scene, "path", {0, 8}, size_px), history), 0);
    if (change) change(*history);
    const SequencePicture picture = picture_at(scene, "path", {1, 8}, size_px);
    auto                  planes  = download_as<uint32_t>(device(), picture.gbuffer->gradient);
    for (size_t i = 0; i < planes.size(); i += 7) planes[i] = pack_gradient(glm::vec2(float(not_a_number))); // no plane
    upload(device(), picture.gbuffer->gradient, planes.data(), planes.size() * sizeof(uint32_t));
    Frame frame;
    prepared(picture, nullptr);
    frame.own      = read_colours(picture.buffers->reflection);
    const auto run = prepared(picture, history);
    EXPECT_EQ(run->inputs.rays->rays_of_pixels, 0) << "the list holds rays";
    frame.result          = read_colours(picture.buffers->reflection);
    frame.image           = read_gbuffer(device(), *picture.gbuffer);
    frame.gradient        = download_as<uint32_t>(device(), picture.gbuffer->gradient);
    frame.rays            = read_list<float>(device(), *run->inputs.rays);
    frame.hits            = download_as<PackedHit<float>>(device(), run->inputs.rays->hits, frame.rays.size());
    frame.reprojected     = download_as<glm::vec4>(device(), history->reprojected);
    frame.kept_reflection = download_as<glm::vec4>(device(), history->kept_reflection);
    frame.kept_facts      = download_as<glm::vec4>(device(), history->kept_facts);
    if (const auto counts = read_history_counts(device(), *run))
        frame.counted = std::bit_cast<decltype(frame.counted)>(*counts);
    if (passes.contains(chosen(TraceResolution::half).first))
        frame.blocks = download_as<uint32_t>(device(), picture.buffers->block_pixel);

    const FrameMotion motion  = motion_at(scene_at(scene, 1), "path", size_px, 1).value();
    Before&           before  = frame.before;
    before.view               = motion.previous_view;
    before.jitter_px          = jitter_px({0, 8});
    before.now_jitter_px      = jitter_px({1, 8});
    const glm::dmat4 to_world = glm::inverse(motion.view.world_to_view);
    before.to_previous_vs     = {before.view.world_to_view * to_world};
    for (const glm::dmat4& draw : motion.to_previous_ws)
        before.to_previous_vs.push_back(before.view.world_to_view * draw * to_world);
    before.depth      = download_as<float>(device(), history->depth);
    before.gradient   = download_as<uint32_t>(device(), history->gradient);
    before.normal     = download_as<glm::vec4>(device(), history->normal);
    before.reflection = download_as<glm::vec4>(device(), history->reflection);
    before.facts      = download_as<glm::vec4>(device(), history->facts);
    return frame;
}

constexpr const char* all_strategies[] = {"surface",       "hit",  "surface_parallax", "hit_parallax", "smallest",
                                          "carried_plane", "plane"};

ParameterValues passes_of(const std::string& id, const ParameterValues& more)
{
    ParameterValues passes{strategy(id), chosen(Gloss::off)};
    if (id == "smallest" || id.ends_with("parallax")) passes[id + ".factor"] = factor;
    passes.insert(more.begin(), more.end());
    return passes;
}

/// Floats of positions up to 40 m are off by 2^-18 m or less, which a pixel of 1 / 60 m at 1 m shows as less than a thousandth of a pixel; what lies nearer
/// to the camera is left out. Sums and differences of a few of them, and vectors of up to 100 px that are multiplied: ten times that.
constexpr double vector_error_px = 0.01;

void expect_strategy(const std::string& id, Projection projection, int per_pixel, double ray_offset_m, int layers,
                     bool was_ahead = false)
{
    SCOPED_TRACE(id + (projection == Projection::orthographic ? ", orthographic, " : ", ") + std::to_string(per_pixel) +
                 " rays, " + std::to_string(layers) + " layers, offset " + std::to_string(ray_offset_m));
    TraceSettings trace = boxes({.thickness_m = 0.1, .max_distance_m = 100, .ray_offset_m = ray_offset_m});
    trace.layers        = layers;
    const Frame frame  = second_frame(projection, passes_of(id, {{"rays_per_pixel", per_pixel}}), trace, {}, was_ahead);
    size_t      judged = 0, deeper = 0;
    for (size_t first = 0; first < frame.rays.size(); first += size_t(per_pixel)) {
        const size_t i = pixel_index(unpack_pixel(frame.rays[first].pixel), size_px);
        glm::dvec2   sum_px(0);
        double       length_m = 0;
        int          hits = 0, seen = 0;
        uint32_t     object = 0;
        bool         known  = true;
        for (size_t ray = first; ray < first + size_t(per_pixel); ++ray) {
            if (unpack_status(frame.hits[ray].pixel) != TraceStatus::hit) continue;
            const Told told  = told_by(frame, ray, ray_offset_m);
            const int  layer = unpack_layer(frame.hits[ray].pixel);
            deeper += layer > 0;
            ++hits;
            length_m += told.length_m;
            const size_t h = pixel_index(unpack_pixel(frame.hits[ray].pixel), size_px);
            object = layer > 0 ? frame.image.layers.at(size_t(layer - 1)).object_id[h] : frame.image.object_id[h];
            const auto place = placed(id, frame.before, told);
            // Rounding rules close to the eye.
            const auto far = [&](glm::dvec3 p) {
                return projection == Projection::orthographic || p.z < -1 || p.z > 0.1;
            };
            known = known && place && far(told.hit_pvs) && far(told.incidence_pvs);
            if (!known || std::isnan(place->x)) continue;
            ++seen;
            sum_px += *place - told.incidence_px;
        }
        if (!known || hits == 0) continue;
        ++judged;
        const glm::vec4& found = frame.reprojected[i];
        ASSERT_NEAR(found.z, length_m / hits, 1e-3) << i;
        ASSERT_EQ(found.w, float(object)) << i;
        ASSERT_EQ(std::isnan(found.x), seen == 0) << i;
        if (seen == 0) continue;
        const glm::dvec2 expected = sum_px / double(seen);
        const double     bound    = vector_error_px * (1 + glm::length(expected) / 100);
        ASSERT_NEAR(found.x, expected.x, bound) << i;
        ASSERT_NEAR(found.y, expected.y, bound) << i;
    }
    EXPECT_GT(judged, 500U);
    EXPECT_TRUE(layers == 1 || deeper > 10) << deeper;
}

TEST(ReprojectionTwin, OfEveryStrategyAndProjection)
{
    for (const char* id : all_strategies)
        for (const Projection projection : {Projection::perspective, Projection::orthographic})
            expect_strategy(id, projection, 1, 0, 1);
}

TEST(ReprojectionTwin, OfSeveralRaysOffsetsAndLayers)
{
    for (const char* id : {"plane", "carried_plane"}) {
        expect_strategy(id, Projection::perspective, 4, 0, 1);
        expect_strategy(id, Projection::perspective, 1, 0, std::min(2, most_layers()));
    }
    expect_strategy("plane", Projection::orthographic, 3, 0.2, 1);
    expect_strategy("smallest", Projection::perspective, 4, 0.2, 1);
    for (const char* strategy_id : {"surface", "smallest", "carried_plane"})
        expect_strategy(strategy_id, Projection::perspective, 1, 0, 1, true);
}

/// As shaders/layout/frame_shared.h numbers them; the counts are all that the device says of them.
struct Outcome {
    uint32_t   number = HISTORY_ACCUMULATED;
    glm::dvec4 reflection{0}; // colour times weight, weight
    double     frames = 0, share = 1;
};

constexpr double hit_unknown = -1, hit_nothing = -2;

struct Rules {
    double reject_depth, reject_normal, length_tolerance;
    bool   reject_hit;
};

/// Of the block of a pixel, the one with rays.
glm::vec4 reprojected_of(const Frame& frame, glm::ivec2 pixel)
{
    pixel = glm::clamp(pixel, glm::ivec2(0), size_px - 1);
    if (!frame.blocks.empty()) {
        const uint32_t traced = frame.blocks[pixel_index(pixel / 2, (size_px + 1) / 2)];
        if (traced != NO_PIXEL) pixel = unpack_pixel(traced);
    }
    return frame.reprojected[pixel_index(pixel, size_px)];
}

/// A miss moves with the nearest hit about it.
glm::vec4 vector_of(const Frame& frame, glm::ivec2 pixel)
{
    glm::vec4 now = reprojected_of(frame, pixel);
    if (now.w != -2) return now;
    const int step = frame.blocks.empty() ? 1 : 2;
    for (int y = -step; y <= step; y += step)
        for (int x = -step; x <= step; x += step) {
            const glm::vec4 next = reprojected_of(frame, pixel + glm::ivec2(x, y));
            if (next.w >= 0 && !std::isnan(next.x) && (now.w < 0 || next.z < now.z)) now = next;
        }
    return now;
}

/// How far the previous frame's surface may be where the pixel's was a plane: distance along its view ray at `px` to the carried plane.
double expected_m(const Frame& frame, glm::ivec2 pixel, glm::dvec2 px)
{
    const size_t      i    = pixel_index(pixel, size_px);
    const View &      view = frame.image.view, &previous = frame.before.view;
    const double      depth    = double(frame.image.depth[i]);
    const glm::dvec2  gradient = unpack_gradient(frame.gradient[i]), centre = glm::dvec2(pixel) + 0.5;
    const glm::dmat4& matrix   = frame.before.to_previous_vs[frame.image.object_id[i]];
    const auto        on_plane = [&](glm::dvec2 step) {
        return px_to_vs(view, centre + step, depth + (step.x == 0 && step.y == 0 ? 0 : glm::dot(gradient, step)));
    };
    const glm::dvec3 point  = on_plane({0, 0});
    glm::dvec3       normal = glm::normalize(glm::dvec3(frame.image.normal_vs[i]));
    if (!std::isnan(gradient.x))
        normal = glm::normalize(glm::cross(on_plane({0.01, 0}) - point, on_plane({0, 0.01}) - point));
    const glm::dvec3 to = carried(matrix, point), turned_normal = turned(matrix, normal);
    // The view ray starts at the eye, or at the near end of an orthographic view.
    const glm::dvec3 from = previous.projection == Projection::perspective
                                ? glm::dvec3(0)
                                : px_to_vs(previous, px, distance_to_depth(previous, 0)),
                     next = px_to_vs(previous, px, distance_to_depth(previous, 1));
    return glm::dot(turned_normal, to - from) / glm::dot(turned_normal, next - from);
}

/// Nothing: rounding decides.
std::optional<Outcome> outcome_of(const Frame& frame, glm::ivec2 pixel, const Rules& rules)
{
    const size_t    i   = pixel_index(pixel, size_px);
    const Before&   was = frame.before;
    const glm::vec4 now = vector_of(frame, pixel);
    if (std::isnan(now.x)) return Outcome{HISTORY_UNSEEN};
    const glm::dvec2 place = glm::dvec2(pixel) + 0.5 + glm::dvec2(now);
    if (near_border(place)) return std::nullopt;
    if (!inside(place)) return Outcome{HISTORY_OFF_IMAGE};
    const glm::dvec2 px = place - was.now_jitter_px, drawn = px + was.jitter_px;
    if (near_border(drawn)) return std::nullopt;
    if (rules.reject_depth > 0) {
        const double expected = expected_m(frame, pixel, px), depth = previous_depth(was, px);
        const double off = std::abs(depth_to_distance(was.view, depth) - expected);
        if (depth > 0 && std::abs(off - rules.reject_depth * expected) < 1e-3 * std::abs(expected)) return std::nullopt;
        if (depth <= 0 || !(off <= rules.reject_depth * expected)) return Outcome{HISTORY_OTHER_DEPTH};
    }
    if (rules.reject_normal > -1) {
        const glm::dmat4& matrix = was.to_previous_vs[frame.image.object_id[i]];
        const glm::dvec3  normal = turned(matrix, glm::normalize(glm::dvec3(frame.image.normal_vs[i]))),
                         stored  = inside(drawn) ? glm::dvec3(was.normal[pixel_index(glm::ivec2(drawn), size_px)])
                                                 : glm::dvec3(0);
        const double cosine      = glm::dot(normal, stored) / glm::length(stored);
        if (std::abs(cosine - rules.reject_normal) < 1e-5) return std::nullopt;
        if (glm::length(stored) > 0 && cosine < rules.reject_normal) return Outcome{HISTORY_OTHER_NORMAL};
    }
    const glm::dvec4 facts(was.facts[pixel_index(glm::ivec2(place), size_px)]);
    const double     met = double(now.w);
    // Camera and objects move.
    if (met == hit_nothing && facts.z != hit_nothing) return Outcome{HISTORY_OTHER_HIT};
    const bool known = facts.z != hit_unknown && met != hit_unknown;
    if (rules.reject_hit && known && facts.z != met) return Outcome{HISTORY_OTHER_HIT};
    const glm::dvec2 low = glm::floor(place - 0.5), part = place - 0.5 - low;
    glm::dvec4       sum(0);
    double           total = 0;
    for (int corner = 0; corner < 4; ++corner) {
        const glm::ivec2 step(corner % 2, corner / 2);
        const glm::dvec4 stored(
            was.reflection[pixel_index(glm::clamp(glm::ivec2(low) + step, glm::ivec2(0), size_px - 1), size_px)]);
        const double weight = (step.x == 1 ? part.x : 1 - part.x) * (step.y == 1 ? part.y : 1 - part.y);
        if (stored.a < 0) continue;
        sum += weight * stored;
        total += weight;
    }
    if (total == 0) return Outcome{HISTORY_OTHER_DEPTH};
    if (total < 0.01) return std::nullopt; // a quotient of next to nothing
    Outcome outcome{HISTORY_ACCUMULATED, sum / total, std::max(facts.x, 1.0)};
    if (rules.length_tolerance > 0 && known) {
        if (facts.z >= 0 && met >= 0)
            outcome.share = std::exp(-std::abs(facts.y - double(now.z)) / (rules.length_tolerance * double(now.z)));
        if ((facts.z >= 0) != (met >= 0)) outcome.share = 0;
    }
    return outcome;
}

/// Makes the history one that no frame leaves, with every case in it.
void scramble(FrameHistory& history)
{
    std::mt19937                          random(23);
    std::uniform_real_distribution<float> unit(0, 1);
    const auto change = [&]<typename Texel>(GpuImage& image, const std::function<void(Texel&)>& to) {
        auto texels = download_as<Texel>(device(), image);
        for (Texel& texel : texels) to(texel);
        upload(device(), image, texels.data(), texels.size() * sizeof(Texel));
    };
    change.     operator()<glm::vec4>(history.reflection, [&](glm::vec4& r) {
        r = random() % 2 == 0 ? glm::vec4(-9, -9, -9, -1)
                                   : glm::vec4(unit(random), 2 * unit(random), 0.5F, 0.25F + 0.75F * unit(random));
    });
    const float frames[] = {0, 0.5F, 1, 3, 40}, objects[] = {-2, -1, 1, 2, 2, 2, 3, 4};
    change.     operator()<glm::vec4>(history.facts, [&](glm::vec4& f) {
        f = glm::vec4(frames[random() % 5], 2 + 12 * unit(random), objects[random() % 8], 0);
    });
    change.     operator()<float>(history.depth, [&](float& d) {
        if (random() % 8 == 0) d *= random() % 2 == 0 ? 1.3F : 0.97F;
    });
    // So steep that within a pixel depth doubles, or is next to nothing.
    change.operator()<uint32_t>(history.gradient, [&](uint32_t& g) {
        if (random() % 4 == 0) g = pack_gradient({0.03F * (unit(random) - 0.5F), 0.03F * (unit(random) - 0.5F)});
    });
    // Of no unit length, and turned.
    change.operator()<glm::vec4>(history.normal, [&](glm::vec4& n) {
        n *= random() % 8 == 0 ? -1 : 0.5F + unit(random);
        if (random() % 8 == 0) n += glm::vec4(0.8F * unit(random), 0, 0.8F * unit(random), 0);
    });
}

// H = own + (H_before - own) * weight. Float sums of a few values of at most 2 (2^-22), the exponential (some 2^-20), half floats where they are stored.
void expect_history(Projection projection, const Rules& rules, bool half, std::array<size_t, HISTORY_COUNTS>& outcomes)
{
    constexpr double weight_limit = 0.75;
    ParameterValues  more{chosen(HistoryClamping::off),
                         {"reject_depth", rules.reject_depth},
                         {"reject_normal", rules.reject_normal},
                         {"reject_hit", rules.reject_hit},
                         {"hit_distance_tolerance", rules.length_tolerance},
                         {"history_weight", weight_limit},
                         {"environment_fallback", 0}};
    if (half) more.insert(chosen(TraceResolution::half));
    const Frame                        frame = second_frame(projection, passes_of("surface", more),
                                                            boxes({.thickness_m = 0.1, .max_distance_m = 100}), scramble);
    std::array<size_t, HISTORY_COUNTS> found{};
    size_t                             undecided = 0;
    for (size_t i = 0; i < frame.own.size(); ++i) {
        if (frame.own[i].a < 0) continue;
        const auto outcome = outcome_of(frame, pixel_at(i, size_px), rules);
        undecided += !outcome;
        if (!outcome) continue;
        ++found.at(outcome->number);
        const glm::dvec4 own(glm::vec3(frame.own[i]) * frame.own[i].a, frame.own[i].a);
        const glm::vec4 &kept = frame.kept_reflection[i], &facts = frame.kept_facts[i],
                        now = vector_of(frame, pixel_at(i, size_px));
        const bool   taken  = outcome->number == HISTORY_ACCUMULATED;
        const double weight =
            taken ? std::min(outcome->frames / (outcome->frames + 1), weight_limit) * outcome->share : 0;
        const glm::dvec4 expected = own + (outcome->reflection - own) * weight;
        ASSERT_NEAR(facts.x, taken ? outcome->frames * outcome->share + 1 : 1, 1e-3)
            << i << ", outcome " << outcome->number;
        ASSERT_EQ(facts.y, now.z) << i;
        ASSERT_EQ(facts.z, now.w) << i;
        for (int c = 0; c < 4; ++c) ASSERT_NEAR(kept[c], expected[c], 1e-3) << i << ", outcome " << outcome->number;
        const glm::dvec4 shown(glm::vec3(frame.result[i]) * frame.result[i].a, frame.result[i].a);
        for (int c = 0; c < 4; ++c) ASSERT_NEAR(shown[c], expected[c], 4e-3) << i;
    }
    for (size_t number = 0; number < HISTORY_CLAMPED; ++number) {
        EXPECT_GE(frame.counted[number], found[number]) << number;
        EXPECT_LE(frame.counted[number], found[number] + undecided) << number;
        outcomes[number] += found[number];
    }
}

TEST(HistoryTwin, OfEveryRule)
{
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        std::array<size_t, HISTORY_COUNTS> outcomes{};
        for (const bool half : {false, true}) {
            SCOPED_TRACE(std::string(projection == Projection::perspective ? "perspective" : "orthographic") +
                         (half ? ", half" : ""));
            expect_history(projection,
                           {.reject_depth = 0.02, .reject_normal = 0.9, .length_tolerance = 0, .reject_hit = false},
                           half, outcomes);
            expect_history(projection,
                           {.reject_depth = 0, .reject_normal = -1, .length_tolerance = 0.3, .reject_hit = false}, half,
                           outcomes);
            expect_history(projection,
                           {.reject_depth = 0, .reject_normal = -1, .length_tolerance = 0.3, .reject_hit = true}, half,
                           outcomes);
        }
        EXPECT_GT(outcomes[HISTORY_ACCUMULATED], 1000U);
        // A ray that hits nothing has no vector in an orthographic view.
        EXPECT_EQ(outcomes[HISTORY_UNSEEN] > 100, projection == Projection::orthographic);
        for (const int number : {HISTORY_OFF_IMAGE, HISTORY_OTHER_DEPTH, HISTORY_OTHER_NORMAL, HISTORY_OTHER_HIT})
            EXPECT_GT(outcomes.at(number), 100U) << number;
    }
}

} // namespace
} // namespace ssrlab::test
