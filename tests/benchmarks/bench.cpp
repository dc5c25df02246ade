#include "benchmarks/bench.h"

#include "benchmarks/visits_bound.h"
#include "compare/measures.h"
#include "core/error.h"
#include "harness/quality.h"
#include "scene/load_scene.h"
#include "shared.h"
#include "truth/truth_cache.h"

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <numeric>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

// Every ray sees the whole segment, so that all tracers answer the same question.
const FrameSettings settings{.trace = {.thickness_m = 0.1, .max_distance_m = 1e9}};

constexpr int largest_truth_px = 1920; // the truth of a larger picture takes minutes

/// Every technique as it comes (marches in pixels: they have no metres to divide an unlimited ray by), and what hiz is compared with.
std::vector<Contender> all_contenders(std::span<const Technique> techniques)
{
    std::vector<Contender> list;
    for (const Technique& technique : techniques) {
        Contender contender{technique.id, technique.id, {}};
        for (const Parameter& parameter : technique.parameters)
            if (parameter.name == "space") contender.values["space"] = "screen";
        list.push_back(contender);
    }
    list.push_back({"hiz_minmax", "hiz", {{"pyramid", "minmax"}}});
    list.push_back({"hiz_nearest", "hiz", {{"pyramid", "nearest"}}});
    list.push_back({"hiz_nearest_stop", "hiz", {{"pyramid", "nearest_stop"}, {"max_steps", "128"}}});
    return list;
}

double cpu_ms()
{
    timespec time{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}

size_t count_traced(const TraceResult& result)
{
    return static_cast<size_t>(
        std::ranges::count_if(result.status, [](TraceStatus s) { return s != TraceStatus::not_traced; }));
}

size_t count_different(const TraceResult& a, const TraceResult& b, bool compare_t)
{
    size_t different = 0;
    for (size_t i = 0; i < a.status.size(); ++i) {
        const bool hit = a.status[i] == TraceStatus::hit;
        different += a.status[i] != b.status[i] ||
                     (hit && (a.hit_pixel[i] != b.hit_pixel[i] || (compare_t && a.hit_t[i] != b.hit_t[i])));
    }
    return different;
}

double percentile_99(std::vector<uint32_t> steps, const TraceResult& result)
{
    std::vector<uint32_t> traced;
    for (size_t i = 0; i < steps.size(); ++i)
        if (result.status[i] != TraceStatus::not_traced) traced.push_back(steps[i]);
    if (traced.empty()) return 0;
    const auto place = traced.begin() + static_cast<ptrdiff_t>(traced.size() * 99 / 100);
    std::ranges::nth_element(traced, place);
    return *place;
}

/// The mean of the state's iterations in milliseconds.
template <typename Call> double measure_calls(benchmark::State& state, const Call& call)
{
    double total_ms = 0;
    call(); // the caches hold what the pass before this one left: one run brings this one's
    const double cpu_before_ms = cpu_ms();
    for (auto _ : state) {
        const double ms = call();
        total_ms += ms;
        state.SetIterationTime(ms * 1e-3);
    }
    const auto count         = static_cast<double>(state.iterations());
    state.counters["cpu_ms"] = (cpu_ms() - cpu_before_ms) / count;
    return total_ms / count;
}

} // namespace

template <typename Record> double Bench::measure(benchmark::State& state, Picture& p, const Record& record)
{
    return measure_calls(state, [&] {
        submit(gpu_, [&](const vk::raii::CommandBuffer& commands) {
            write_timestamp(commands, p.timestamps, 0);
            barrier(commands);
            record(commands);
            barrier(commands);
            write_timestamp(commands, p.timestamps, 1);
        });
        return read_intervals_ms(gpu_, p.timestamps)[0];
    });
}

Bench::Bench(const std::string& device)
    : gpu_(open_gpu({.device = device})),
      techniques_(list_techniques(std::vector<fs::path>{fs::path(SSRLAB_SOURCE_DIR) / "tests/techniques"})),
      contenders_(all_contenders(techniques_))
{
}

void Bench::gbuffer(benchmark::State& state, const std::string& scene, glm::ivec2 size_px)
{
    Picture& p = picture(scene, size_px);
    measure_calls(state, [&] { return rerender_gbuffer(gpu_, *p.gbuffer); });
}

void Bench::copy(benchmark::State& state, const std::string& scene, glm::ivec2 size_px)
{
    Picture& p = picture(scene, size_px);
    measure(state, p, [&](const auto& commands) { dispatch(commands, p.copy_pass, groups_of_8(size_px)); });
}

void Bench::pyramid(benchmark::State& state, const std::string& scene, glm::ivec2 size_px, const std::string& kind)
{
    Picture&       p     = picture(scene, size_px);
    PreparedFrame& frame = frame_of(p, contender(kind == "occupancy" ? "hiz" : "hiz_" + kind));
    measure(state, p, [&](const auto& commands) { record_pyramid(commands, frame.pyramid); });
}

void Bench::rays(benchmark::State& state, const std::string& scene, glm::ivec2 size_px)
{
    Picture&       p     = picture(scene, size_px);
    PreparedFrame& frame = frame_of(p, contender("dda"));
    measure(state, p, [&](const auto& commands) { record_rays(commands, frame.trace, *p.buffers, *frame.rays); });
}

void Bench::trace(benchmark::State& state, const std::string& scene, glm::ivec2 size_px, const Contender& tracer)
{
    Picture&       p     = picture(scene, size_px);
    PreparedFrame& frame = frame_of(p, tracer);
    Judgement      work  = judgement_of(p, tracer);
    prepare_trace(*p.buffers, frame);
    const double ms = measure(
        state, p, [&](const auto& commands) { dispatch_indirect(commands, frame.trace.trace, frame.rays->launch); });
    state.counters["rays"]            = work.rays;
    state.counters["visits_per_ray"]  = work.visits;
    state.counters["visits_p99"]      = work.visits_p99;
    state.counters["fetches_per_ray"] = work.fetches;
    state.counters["ns_per_ray"]      = work.rays > 0 ? ms * 1e6 / work.rays : 0;
    if (size_px.x <= largest_truth_px) state.counters["recall"] = work.recall;
}

void Bench::shade(benchmark::State& state, const std::string& scene, glm::ivec2 size_px)
{
    Picture&       p     = picture(scene, size_px);
    PreparedFrame& frame = frame_of(p, contender("hiz"));
    prepare_trace(*p.buffers, frame);
    submit(gpu_, [&](const auto& commands) { dispatch_indirect(commands, frame.trace.trace, frame.rays->launch); });
    const Recording hit_colour = make_recording(gpu_, frame, "hit_colour"),
                    composite  = make_recording(gpu_, frame, "composite");
    measure(state, p, [&](const auto& commands) {
        hit_colour(commands);
        barrier(commands);
        composite(commands);
    });
}

void Bench::scattered(benchmark::State& state, const std::string& scene, glm::ivec2 size_px, bool compacted)
{
    Picture& p = picture(scene, size_px);
    if (!p.scattered) p.scattered = scatter(p);
    Scattered& s = *p.scattered;
    prepare_trace(*s.buffers, *s.frame);
    measure(state, p, [&](const auto& commands) {
        if (compacted)
            dispatch_indirect(commands, s.frame->trace.trace, s.frame->rays->launch);
        else
            dispatch_indirect(commands, s.over_every_pixel.trace, s.every_pixel.launch);
    });
    state.counters["rays"] = static_cast<double>(s.frame->rays->capacity);
}

void Bench::judge(benchmark::State& state, const std::string& scene, glm::ivec2 size_px)
{
    Picture&         p    = picture(scene, size_px);
    const Judgement& work = judgement_of(p, contender("hiz"));
    for (auto _ : state) state.SetIterationTime(1e-9);
    state.counters["rays"]              = work.rays;
    state.counters["differs_from_walk"] = work.differs_from_walk;
    if (size_px.x > largest_truth_px) return;
    state.counters["differs_from_truth"] = work.differs_from_truth;
    state.counters["missed"]             = work.missed;
    state.counters["visits_bound"] =
        visits_with_perfect_cells(read_gbuffer(gpu_, *p.gbuffer), settings.trace, truth_of(p), 7);
    state.counters["visits_per_ray"] = work.visits;
}

Bench::Picture& Bench::picture(const std::string& scene, glm::ivec2 size_px)
{
    const auto [place, is_new] = pictures_.try_emplace(fmt::format("{} {}x{}", scene, size_px.x, size_px.y));
    Picture& p                 = place->second;
    if (!is_new) return p;
    if (!scenes_.contains(scene)) {
        const Scene loaded = load_scene(scene);
        scenes_[scene]     = {upload_scene(gpu_, loaded), find_camera(loaded, "default")};
    }
    p.gbuffer = render_gbuffer(gpu_, scenes_[scene].gpu, camera_to_view(scenes_[scene].camera, size_px));
    p.buffers = make_frame_buffers(gpu_, p.gbuffer);
    p.copy    = make_image(
           gpu_, {.format = vk::Format::eR32Sfloat, .size_px = size_px, .usage = vk::ImageUsageFlagBits::eStorage});
    p.copy_pass  = make_compute_pass(gpu_, compile_shader({.file = "copy_depth.comp"}),
                                     {{"depth_image", p.gbuffer->depth}, {"depth_copy", p.copy}});
    p.timestamps = make_timestamps(gpu_, 2);
    return p;
}

const Contender& Bench::contender(const std::string& name) const
{
    return *std::ranges::find(contenders_, name, &Contender::name);
}

/// Compiled, and run once so that the driver has compiled it, too.
PreparedFrame& Bench::frame_of(Picture& p, const Contender& c)
{
    if (!p.frames.contains(c.name)) {
        const Technique& technique = find_technique(techniques_, c.technique);
        ParameterValues  values    = default_values(technique);
        for (const auto& [name, text] : c.values)
            values.at(name) = parse_parameter(find_parameter(technique, name, "benchmark"), text, "benchmark");
        p.frames[c.name] = prepare_frame(gpu_, p.buffers, technique, values, settings);
        run_frame(gpu_, *p.frames[c.name]);
    }
    return *p.frames[c.name];
}

const TraceResult& Bench::truth_of(Picture& p)
{
    if (!p.truth)
        p.truth = cached_screen_truth(truth_cache_dir(fs::path(SSRLAB_SOURCE_DIR) / "results/bench"),
                                      read_gbuffer(gpu_, *p.gbuffer), settings.trace);
    return *p.truth;
}

const TraceResult& Bench::walk_of(Picture& p)
{
    if (!p.walk) p.walk = count_frame(gpu_, frame_of(p, contender("dda")));
    return *p.walk;
}

const Judgement& Bench::judgement_of(Picture& p, const Contender& c)
{
    const auto [place, is_new] = p.judgements.try_emplace(c.name);
    Judgement& judged          = place->second;
    if (!is_new) return judged;
    const TraceResult result = count_frame(gpu_, frame_of(p, c));
    const auto        mean   = [&](const std::vector<uint32_t>& v) {
        return std::accumulate(v.begin(), v.end(), 0.0) / std::max(judged.rays, 1.0);
    };
    judged.rays       = static_cast<double>(count_traced(result));
    judged.visits     = mean(result.steps);
    judged.visits_p99 = percentile_99(result.steps, result);
    judged.fetches    = mean(result.depth_fetches) + mean(result.pyramid_fetches);
    if (c.name == "hiz") judged.differs_from_walk = static_cast<double>(count_different(result, walk_of(p), true));
    if (result.size_px.x > largest_truth_px) return judged;
    const MeasureValues measures = compare_to_screen_truth(result, truth_of(p));
    judged.recall                = measures.at("screen_recall_1px").value_or(0);
    judged.missed                = measures.at("screen_missed").value_or(0) * judged.rays;
    judged.differs_from_truth =
        static_cast<double>(count_different(result, truth_of(p), false)) / std::max(judged.rays, 1.0);
    return judged;
}

/// One of 16 pixels keeps its metal, chosen by a hash of its place.
Bench::Scattered Bench::scatter(Picture& p)
{
    GBufferImage image = read_gbuffer(gpu_, *p.gbuffer);
    for (size_t i = 0; i < image.metallic.size(); ++i)
        if (static_cast<uint32_t>(i) * 2654435761U >> 28 != 0) image.metallic[i] = 0;
    Scattered s;
    s.gbuffer                  = upload_gbuffer(gpu_, image);
    s.buffers                  = make_frame_buffers(gpu_, s.gbuffer);
    const Technique& technique = find_technique(techniques_, "hiz");
    s.frame                    = prepare_frame(gpu_, s.buffers, technique, default_values(technique), settings);
    run_frame(gpu_, *s.frame);

    const glm::ivec2 size                 = p.gbuffer->view.size_px;
    const auto       capacity             = static_cast<size_t>(size.x) * static_cast<size_t>(size.y);
    const size_t     count                = s.frame->rays->capacity;
    s.every_pixel                         = make_ray_buffers(gpu_, capacity, Precision::float32);
    s.over_every_pixel                    = make_trace_passes(gpu_, *s.frame, s.every_pixel, s.buffers->view, nullptr);
    const auto             listed_origins = download_as<glm::vec3>(gpu_, s.frame->rays->origins, count);
    const auto             listed_deltas  = download_as<glm::vec3>(gpu_, s.frame->rays->deltas, count);
    const auto             listed_lengths = download_as<float>(gpu_, s.frame->rays->lengths, count);
    const auto             listed_pixels  = download_as<uint32_t>(gpu_, s.frame->rays->pixels, count);
    std::vector<glm::vec3> origins(capacity), deltas(capacity);
    std::vector<float>     lengths(capacity);
    std::vector<uint32_t>  pixels(capacity);
    for (size_t i = 0; i < capacity; ++i)
        origins[i] = {static_cast<float>(i % static_cast<size_t>(size.x)) + 0.5F,
                      static_cast<float>(i / static_cast<size_t>(size.x)) + 0.5F, 1};
    for (size_t i = 0; i < count; ++i) {
        const uint32_t x   = listed_pixels[i] & (MAX_IMAGE_PX - 1),
                       y   = (listed_pixels[i] >> PIXEL_BITS) & (MAX_IMAGE_PX - 1);
        const size_t place = static_cast<size_t>(y) * static_cast<size_t>(size.x) + x;
        origins[place]     = listed_origins[i];
        deltas[place]      = listed_deltas[i];
        lengths[place]     = listed_lengths[i];
        pixels[place]      = listed_pixels[i];
    }
    const auto all = static_cast<uint32_t>(capacity);
    upload(gpu_, s.every_pixel.count, &all, sizeof(all));
    upload(gpu_, s.every_pixel.origins, origins.data(), capacity * sizeof(origins[0]));
    upload(gpu_, s.every_pixel.deltas, deltas.data(), capacity * sizeof(deltas[0]));
    upload(gpu_, s.every_pixel.lengths, lengths.data(), capacity * sizeof(lengths[0]));
    upload(gpu_, s.every_pixel.pixels, pixels.data(), capacity * sizeof(pixels[0]));
    submit(gpu_, [&](const auto& commands) {
        barrier(commands);
        dispatch(commands, s.over_every_pixel.ray_launch, {1, 1, 1});
        barrier(commands);
    });
    return s;
}

/// Rays and inputs in place: another benchmark may have used the buffers.
void Bench::prepare_trace(const FrameBuffers& buffers, PreparedFrame& frame)
{
    submit(gpu_, [&](const auto& commands) {
        record_rays(commands, frame.trace, buffers, *frame.rays);
        record_pyramid(commands, frame.pyramid);
    });
}

} // namespace ssrlab
