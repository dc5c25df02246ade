// Techniques that claim to be exact, held to it: the pixel walk's answer on every ray, whatever their parameters.
#include "contract/disputed_rays.h"
#include "core/files.h"
#include "core/pixel_index.h"
#include "gpu/device.h"
#include "scene/scene.h"
#include "trace/lab.h"
#include "truth/pixel_surface.h"
#include "truth/screen_truth.h"
#include "unit/truth_gbuffers.h"

namespace ssrlab::test {
namespace {

enum class Frames { all_sizes, small, large };

/// Frames of one scene, in one test: they share its pipelines.
struct Case {
    std::string scene;
    Frames      frames = Frames::all_sizes;
};

constexpr const char* frames_names[] = {"", "_small", "_large"};

void PrintTo(const Case& c, std::ostream* out) { *out << c.scene << frames_names[static_cast<int>(c.frames)]; }

std::string case_name(const testing::TestParamInfo<Case>& info)
{
    std::string name = info.param.scene + frames_names[static_cast<int>(info.param.frames)];
    std::ranges::replace_if(
        name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
    return name;
}

struct Frame {
    std::string view;
    glm::ivec2  size_px;
};

constexpr glm::ivec2 odd{641, 363}, even{640, 360}, row{97, 1}, large{1919, 1079}, smaller{321, 181};

/// Real scenes with their views besides the default one; a level one is among them.
const std::map<std::string, std::vector<std::string>> real_scenes = {{"animal_on_metal", {"level", "steep"}},
                                                                     {"teapot_bunnies", {"level", "close"}},
                                                                     {"thin_yard", {"level", "close", "fence"}},
                                                                     {"interior", {"mirror", "low", "piano"}},
                                                                     {"engine", {"level", "close"}},
                                                                     {"forest_clearing", {"level", "close"}}};

/// Here every level of the pyramid is tried in the default view; elsewhere the default levels.
bool is_thorough(const std::string& scene)
{
    return scene == "builtin:stairs" || scene == "builtin:pole_field" || real_scenes.contains(scene);
}

/// Without loading a scene: every process of this program lists its tests.
std::vector<Case> all_cases()
{
    std::vector<Case> cases{
        {"builtin:stairs", Frames::small}, {"builtin:pole_field", Frames::large}, {"engine", Frames::large}};
    for (const auto& [scene, views] : real_scenes) cases.push_back({scene});
    for (const SceneListing& listing : list_scenes())
        if (listing.name.starts_with("builtin:")) cases.push_back({listing.name});
    return cases;
}

std::vector<std::string> other_views(const std::string& scene)
{
    if (const auto real = real_scenes.find(scene); real != real_scenes.end()) return real->second;
    std::vector<std::string> views;
    for (const Camera& camera : load_scene(scene).cameras)
        if (camera.name != "default") views.push_back(camera.name);
    return views;
}

/// Each view of the scene, the default one in this size.
std::vector<Frame> in_every_view(const std::string& scene, glm::ivec2 default_px)
{
    std::vector<Frame> frames{{"default", default_px}};
    for (const std::string& view : other_views(scene)) frames.push_back({view, smaller});
    return frames;
}

std::vector<Frame> frames_of(const Case& c)
{
    if (c.frames == Frames::large) return {{"default", large}};
    std::vector<Frame> frames{{"default", {1, 1}}, {"default", {3, 2}}, {"default", row}};
    if (c.frames == Frames::small) return frames;
    for (const Frame& frame : in_every_view(c.scene, odd)) frames.push_back(frame);
    if (is_thorough(c.scene)) frames.push_back({"default", even});
    return frames;
}

bool is_large(const Frame& frame) { return frame.size_px == large; }

/// Large frames trace metals alone: dielectrics, which the smaller frames have as well, would multiply their rays.
double dielectric_min_f0_for(const Frame& frame) { return is_large(frame) ? 1 : TraceSettings{}.dielectric_min_f0; }

/// Every setting of the parameters that may change the way a technique walks, and must not change what it finds.
std::vector<ParameterValues> variants(const Technique& technique, const std::string& scene, glm::ivec2 size_px)
{
    const bool walks_cells = std::ranges::count(technique.parameters, "start_level", &Parameter::name) > 0 &&
                             std::ranges::count(technique.parameters, "depth_pyramid.kind", &Parameter::name) > 0;
    if (!walks_cells) return {default_values(technique)};
    // Every kind of pyramid at its default levels; every level at the sizes with odd borders, which is where a level may go wrong.
    std::vector<std::pair<int, int>> levels{{0, 7}};
    if (is_thorough(scene) && (size_px == odd || size_px == row))
        levels = {{0, 7}, {0, 0}, {0, 14}, {14, 14}, {5, 3}, {1, 5}};
    std::vector<ParameterValues> list;
    const size_t                 kinds = find_parameter(technique, "depth_pyramid.kind", "test").choices.size();
    for (const auto& [start, top] : levels)
        for (size_t kind = 0; kind < kinds; ++kind)
            list.push_back(values_of(technique, {{"depth_pyramid.kind", static_cast<double>(kind)},
                                                 {"start_level", start},
                                                 {"depth_pyramid.top_level", top}}));
    if (std::ranges::count(technique.parameters, "ray_packets.most_tests", &Parameter::name) > 0)
        list.push_back(values_of(technique, {{"ray_packets.most_tests", 3}}));
    return list;
}

bool same(TraceStatus status, glm::ivec2 hit_pixel, const TraceImage& walk, size_t i)
{
    return status == walk.status[i] && (status != TraceStatus::hit || hit_pixel == walk.hit_pixel[i]);
}

/// The rays that the shader made, at their pixels. As numbers they are exact in double precision, too.
std::vector<ScreenRay> rays_of_the_shader(const Picture& picture, const TraceSettings& settings)
{
    std::vector<ScreenRay> rays(picture.image.depth.size());
    const Technique&       dda    = technique("dda");
    const auto             tracer = tracer_on(picture.gbuffer, dda, values_of(dda), settings, rays.size());
    for (const RayInput& ray : set_up_rays(device(), *tracer)) {
        const auto i            = pixel_index(ray.pixel, picture.view.size_px);
        rays[i].traced          = true;
        rays[i].origin_px_depth = ray.origin_px_depth;
        rays[i].delta_px_depth  = ray.delta_px_depth;
        rays[i].start_pixel     = ray.pixel;
        rays[i].end_status      = ray.end_status;
        rays[i].length_m        = ray.length_m;
    }
    return rays;
}

struct Count {
    size_t rays = 0, disputed = 0, ties = 0;
};

/// The most of so many rays that may differ by rounding, where a ray does with this probability: more come by chance once in a million pictures
/// (Poisson's distribution). A picture in which 2.5 are expected may have 11.
size_t most_by_chance(double share, size_t rays)
{
    const double expected = share * static_cast<double>(rays);
    double       up_to    = std::exp(-expected); // the probability of `count` at most
    size_t       count    = 0;
    while (up_to < 1 - 1e-6) {
        const auto k = static_cast<double>(++count);
        up_to += std::exp(k * std::log(expected) - expected - std::lgamma(k + 1));
    }
    return count;
}

/// What single and double precision decide otherwise: by the same rays, and by rays of their own.
struct Rounding {
    Count same_rays, own_rays;
};

/// What rounding does, in two parts. The walk: the same rays, walked in double precision. The rays: made and walked in double precision, which is
/// the screen truth. Only rays may differ that pass within rounding of a corner or a slab's face.
/// Adds to `all` what it counts in default views.
void expect_rounding_only(const Picture& picture, const TraceSettings& settings, const TraceImage& truth,
                          const TraceImage& walk, Rounding& all)
{
    const ScreenWalk             exact_walk(picture.image, settings);
    const std::vector<ScreenRay> shader_rays = rays_of_the_shader(picture, settings);
    Count                        same_rays, own_rays;
    for (size_t i = 0; i < truth.status.size(); ++i) {
        if (truth.status[i] == TraceStatus::not_traced) continue;
        const glm::ivec2 pixel(static_cast<int>(i) % picture.view.size_px.x,
                               static_cast<int>(i) / picture.view.size_px.x);
        const ScreenRay  own_ray = make_screen_ray(picture.image, pixel, settings);
        const auto       add     = [&](Count& count, const ScreenRay& ray, const Answer& answer) {
            ++count.rays;
            if (same(answer.status, answer.hit_pixel, walk, i)) return;
            const Answer  walked{walk.status[i], walk.hit_pixel[i]};
            const Dispute dispute = explain_dispute(picture.image, settings, ray, answer, walked);
            EXPECT_TRUE(dispute.explained()) << dispute.text;
            // Around an exact corner a walk may go on either side: the pixel that it leaves out holds no part of the ray.
            EXPECT_FALSE(dispute.missed && !dispute.tie()) << dispute.text;
            ++count.disputed;
            count.ties += explain_dispute(picture.image, settings, own_ray, answer, walked).tie();
        };
        const WalkResult found = exact_walk.walk(shader_rays[i]);
        add(same_rays, shader_rays[i], {found.status, found.hit_pixel});
        add(own_rays, own_ray, {truth.status[i], truth.hit_pixel[i]});
    }
    // A ray that meets corners exactly in real numbers no longer does so once it is rounded to 24 bits: the views beside the default one, which look
    // straight at mirrors, have more of those than 100 in a million.
    const bool counts_ties = picture.view.name == "default";
    // Quotients of GPUs are up to 2.5 units in the last place off where those of CPUs are half a unit off (Vulkan 1.3, "Precision of Individual
    // Operations"): five times as many rays may pass within rounding of a corner.
    const double most = device().info.type == "Cpu" ? 1e-4 : 5e-4;
    for (const Count& count : {same_rays, own_rays})
        EXPECT_LE(count.disputed - (counts_ties ? 0 : count.ties), most_by_chance(most, count.rays));
    for (auto [sum, count] : {std::pair(&all.same_rays, same_rays), {&all.own_rays, own_rays}}) {
        if (!counts_ties) continue;
        sum->rays += count.rays;
        sum->disputed += count.disputed;
    }
    for (const auto& [what, count] : {std::pair("walk", same_rays), std::pair("rays_and_walk", own_rays)}) {
        testing::Test::RecordProperty(std::string(what) + "_disputed", static_cast<int>(count.disputed));
        if (count.disputed > 0)
            fmt::print("{}: {} of {} rays differ from double precision by rounding, {} through an exact corner\n", what,
                       count.disputed, count.rays, count.ties);
    }
}

class ExactTechniques : public testing::TestWithParam<Case> {};

void expect_exact(const std::string& scene, const Frame& frame, Rounding& rounding)
{
    const Picture       picture = make_picture(scene, frame.view, frame.size_px);
    const TraceSettings settings =
        boxes({.thickness_m = 0.1, .max_distance_m = 1e9, .dielectric_min_f0 = dielectric_min_f0_for(frame)});
    const Technique& dda   = technique("dda");
    const TraceImage walk  = trace(picture, dda, values_of(dda), settings);
    const TraceImage truth = screen_truth(picture.image, settings);
    std::string      first;

    for (const Technique& t : catalogue().techniques) {
        if (!t.exact || t.id == "dda") continue;
        for (const ParameterValues& values : variants(t, scene, frame.size_px))
            EXPECT_EQ(count_differences(trace(picture, t, values, settings), walk, bit_equal_t, first), 0U)
                << first << "\n"
                << repeat_command(scene, frame.view, frame.size_px, t, values, settings);
    }
    expect_rounding_only(picture, settings, truth, walk, rounding);
    if (is_large(frame) || !device().info.float64) return;
    EXPECT_EQ(count_differences(trace(picture, dda, values_of(dda), settings, NumberFormat::float64), truth,
                                double_twins_t, first),
              0U)
        << "double twin: " << first;
}

TEST_P(ExactTechniques, EqualThePixelWalkAndTheScreenTruth)
{
    Rounding rounding;
    for (const Frame& frame : frames_of(GetParam())) expect_exact(GetParam().scene, frame, rounding);
    // About 17 of a million rays are decided by rounding at 640 x 360 and 35 at 1919 x 1079, on lavapipe, SwiftShader and an H100 alike.
    for (const Count& all : {rounding.same_rays, rounding.own_rays})
        EXPECT_LE(all.disputed, most_by_chance(5e-5, all.rays)) << all.rays << " rays of default views";
}

struct Held {
    std::string surface;
    Behind      behind;
    int         layers = 1;
};
const Held every_model[] = {{"box", Behind::pass},           {"box", Behind::stop},
                            {"box_two_sided", Behind::hit},  {"box_infinite", Behind::stop},
                            {"plane", Behind::hit},          {"plane", Behind::pass},
                            {"plane_solid", Behind::stop},   {"box", Behind::stop, 2},
                            {"plane", Behind::pass, 4},      {"plane_solid", Behind::stop, 2},
                            {"plane_solid", Behind::hit, 4}, {"plane_infinite", Behind::stop},
                            {"sloped_slab", Behind::stop}};

std::vector<Frame> frames_for_models(const Case& c)
{
    if (c.frames == Frames::large) return {{"default", large}};
    std::vector<Frame> frames = in_every_view(c.scene, smaller);
    frames.push_back({"default", row});
    return frames;
}

class ExactTechniquesOnModels : public testing::TestWithParam<Case> {};

void expect_exact(const std::string& scene, const Frame& frame, Picture& picture, const Held& held)
{
    const TraceSettings settings{.thickness_m       = 0.1,
                                 .max_distance_m    = 1e9,
                                 .behind            = held.behind,
                                 .surface           = held.surface,
                                 .layers            = held.layers,
                                 .dielectric_min_f0 = dielectric_min_f0_for(frame)};
    const Technique&    dda  = technique("dda");
    const TraceImage    walk = trace(picture, dda, values_of(dda), settings);
    if (static_cast<int>(picture.image.layers.size()) + 1 < held.layers)
        picture.image = read_gbuffer(device(), *picture.gbuffer); // with the layers that the trace has drawn
    const auto repeat = [&](const Technique& t) {
        return repeat_command(scene, frame.view, frame.size_px, t, values_of(t), settings);
    };
    std::string first;
    for (const Technique& t : catalogue().techniques) {
        if (!t.exact || t.id == "dda") continue;
        EXPECT_EQ(count_differences(trace(picture, t, values_of(t), settings), walk, bit_equal_t, first), 0U)
            << first << "\n"
            << repeat(t);
    }
    if (!has_screen_truth(held.surface)) return;
    const TraceImage truth = screen_truth(picture.image, settings);
    const auto       rays  = static_cast<size_t>(
        std::ranges::count_if(truth.status, [](TraceStatus s) { return s != TraceStatus::not_traced; }));
    const size_t near_ties = count_differences(walk, truth, any_t, first);
    // Other views than the default one have ties at exact corners, see expect_rounding_only().
    if (frame.view == "default") {
        EXPECT_LE(near_ties, most_by_chance(2e-4, rays)) << first << "\n" << repeat(dda);
    }
    if (is_large(frame) || !device().info.float64) return;
    EXPECT_EQ(count_differences(trace(picture, dda, values_of(dda), settings, NumberFormat::float64), truth,
                                double_twins_t, first),
              0U)
        << "double twin: " << first << "\n"
        << repeat(dda);
}

TEST_P(ExactTechniquesOnModels, EqualThePixelWalkWhateverAPixelHolds)
{
    const Case& c = GetParam();
    for (const Frame& frame : frames_for_models(c)) {
        Picture picture = make_picture(c.scene, frame.view, frame.size_px);
        for (const Held& held : every_model) {
            const bool skipped = is_large(frame) && (held.surface != "plane_solid" || held.behind != Behind::stop);
            if (held.layers <= most_layers() && !skipped) expect_exact(c.scene, frame, picture, held);
        }
    }
}

const Case model_cases[] = {{"engine"}, {"engine", Frames::large}, {"interior"}, {"thin_yard"}};

INSTANTIATE_TEST_SUITE_P(Scenes, ExactTechniquesOnModels, testing::ValuesIn(model_cases), case_name);

INSTANTIATE_TEST_SUITE_P(Scenes, ExactTechniques, testing::ValuesIn(all_cases()), case_name);

// A pole in the sky, and rays across the picture that keep their distance: they meet it up to its thickness before and behind it. Six metres reach
// behind the eye.
TEST(TwoSidedBoxes, AreMetOnBothSidesOfTheirDepth)
{
    constexpr double pole_m = 5;
    GBufferImage     image  = empty_gbuffer(bench_view({64, 8}));
    for (int y = 0; y < 8; ++y) set_pixel(image, 40, y, pole_m, {0, 0, 1}, 0);
    const GBufferPtr gbuffer       = upload_gbuffer(device(), image);
    constexpr double distances_m[] = {0.2, 3.9, 4.1, 5.9, 6.1, 10.9, 11.1};
    for (const Technique& t : catalogue().techniques) {
        if (!t.exact) continue;
        for (const double thickness_m : {1.0, 6.0}) {
            std::vector<RayInput> rays;
            for (const double distance_m : distances_m)
                rays.push_back({.origin_px_depth = {5.5, 3.5, distance_to_depth(image.view, distance_m)},
                                .delta_px_depth  = {50, 0, 0},
                                .pixel           = {5, 3}});
            const auto tracer =
                tracer_on(gbuffer, t, values_of(t),
                          {.thickness_m = thickness_m, .behind = Behind::hit, .surface = "box_two_sided"}, rays.size());
            const auto found = trace_rays(device(), *tracer, rays);
            for (size_t i = 0; i < rays.size(); ++i) {
                const bool meets = std::abs(distances_m[i] - pole_m) < thickness_m;
                EXPECT_EQ(found[i].status, meets ? TraceStatus::hit : TraceStatus::left_screen)
                    << t.id << " at " << distances_m[i] << " m, thickness " << thickness_m;
                if (!meets) continue;
                EXPECT_EQ(found[i].hit_pixel, glm::ivec2(40, 3)) << t.id;
                EXPECT_NEAR(found[i].t, (40 - 5.5) / 50, 1e-6)
                    << t.id; // where it enters the pixel: it is inside of the box
            }
        }
    }
}

/// The traversal that stops at the first occluder is not exact, but packets must not change what it finds. Those that may pass behind things do.
TEST(FrontPackets, ChangeNoAnswerOfATraversalThatStopsAtTheFirstOccluder)
{
    namespace fs                = std::filesystem;
    const fs::path   folders[]  = {data_root() / "techniques/rivals"};
    const auto       techniques = load_catalogue(folders).techniques;
    const Technique& stops      = find_technique(techniques, "first_occluder");
    Technique        behind     = stops;
    behind.structures           = technique("hiz_packets").structures;
    behind.parameters           = technique("hiz_packets").parameters;
    // The same walk without packets.
    Technique   walks   = stops;
    std::string pattern = (fs::temp_directory_path() / "walks.XXXXXX").string();
    walks.folder        = ::mkdtemp(pattern.data());
    walks.structures    = technique("hiz").structures;
    write_file_atomically(walks.folder / "trace.glsl", "real2 empty_interval(int number) { return real2(2); }\n" +
                                                           read_file(stops.folder / "trace.glsl"));
    const TraceSettings   settings = boxes({.thickness_m = 0.1, .max_distance_m = 1e9});
    const ParameterValues values   = values_of(stops, {{"max_steps", 60000}});
    for (const auto& [scene, view] : {std::pair("interior", "default"), std::pair("interior", "piano"),
                                      std::pair("thin_yard", "default"), std::pair("thin_yard", "fence")}) {
        const Picture    picture = make_picture(scene, view, {641, 363});
        const TraceImage walked  = trace(picture, walks, values, settings);
        std::string      first;
        const auto       differs = [&](const Technique& t, const ParameterValues& of_it) {
            return count_differences(trace(picture, t, of_it, settings), walked, bit_equal_t, first);
        };
        EXPECT_GT(differs(behind, values_of(behind)), 100U) << scene << " " << view;
        EXPECT_EQ(differs(stops, values), 0U) << first << "\n"
                                              << repeat_command(scene, view, {641, 363}, stops, values, settings);
    }
    fs::remove_all(walks.folder);
}

} // namespace
} // namespace ssrlab::test
