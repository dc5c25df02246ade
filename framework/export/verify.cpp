// A host for exported passes: it reads a frame's JSON file, runs the passes that it lists, and compares. It knows nothing of the lab.
#include "core/error.h"
#include "core/files.h"
#include "export/export.h"
#include "gpu/compute.h"
#include "shared.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <deque>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Words = std::vector<uint32_t>;

constexpr size_t ray_words = 8, hit_words = 2; // README.md of an export says what they hold

Words read_words(const fs::path& path)
{
    const std::string bytes = read_file(path);
    Words             words(bytes.size() / sizeof(uint32_t));
    std::memcpy(words.data(), bytes.data(), words.size() * sizeof(uint32_t));
    return words;
}

void require_known_language(const fs::path& file)
{
    if (file.extension() != ".comp" && file.extension() != ".hlsl")
        throw_spec_error("{}: expected .comp (GLSL) or .hlsl; other languages are not run here", file.string());
}

struct Resources {
    std::map<std::string, Buffer>   buffers;
    std::map<std::string, GpuImage> images;
};

Resources make_resources(Gpu& gpu, const json& frame, const fs::path& frames)
{
    Resources        made;
    const glm::ivec2 size_px(frame.at("size_px").at(0), frame.at("size_px").at(1));
    for (const auto& [name, resource] : frame.at("resources").items()) {
        const size_t bytes = resource.at("bytes");
        const Words  words = resource.contains("file") ? read_words(frames / resource.at("file").get<std::string>())
                                                       : Words(bytes / sizeof(uint32_t), resource.at("fill"));
        if (words.size() * sizeof(uint32_t) > bytes) throw_failure("{}: larger than its {} bytes", name, bytes);
        const std::string kind = resource.at("kind");
        if (kind == "buffer" || kind == "uniform") {
            const auto buffer = made.buffers.emplace(name, make_buffer(gpu, std::max<size_t>(bytes, 16))).first;
            if (!words.empty()) upload(gpu, buffer->second, words.data(), words.size() * sizeof(uint32_t));
        } else {
            const auto format = kind == "r32f" ? vk::Format::eR32Sfloat : vk::Format::eR32G32B32A32Sfloat;
            GpuImage   image =
                make_image(gpu, {.format = format, .size_px = size_px, .usage = vk::ImageUsageFlagBits::eStorage});
            upload(gpu, image, words.data(), words.size() * sizeof(uint32_t));
            made.images.emplace(name, std::move(image));
        }
    }
    return made;
}

/// The frame's resources by the names that the shader gives to their bindings.
Bindings bindings_of(const Shader& shader, const json& pass, const Resources& resources, const Buffer& push,
                     const json& frame)
{
    Bindings bindings;
    for (const auto& [name, binding] : shader.bindings) {
        if (binding.binding == frame.at("push_binding")) {
            bindings.insert({name, push});
            continue;
        }
        const std::string resource = pass.at("bindings").at(std::to_string(binding.binding));
        if (const auto image = resources.images.find(resource); image != resources.images.end())
            bindings.insert({name, image->second});
        else
            bindings.insert({name, resources.buffers.at(resource)});
    }
    return bindings;
}

void run_frame(Gpu& gpu, const json& frame, const Resources& resources, const fs::path& folder)
{
    struct Step {
        ComputePass pass;
        glm::uvec3  groups{0};
    };
    std::vector<Step>     steps;
    std::deque<Buffer>    pushed; // a small uniform block for each dispatch
    const ShaderFilesHeld held;
    for (const json& pass : frame.at("passes")) {
        const fs::path file = fs::absolute(folder / pass.at("file").get<std::string>());
        require_known_language(file);
        const Shader shader = compile_shader(gpu, {.file = file});
        for (const json& launch : pass.at("dispatches")) {
            Words values = launch.value("push", Words{});
            values.resize(4);
            pushed.push_back(make_buffer_with(gpu, std::span<const uint32_t>(values)));
            const auto& groups = launch.at("groups");
            steps.push_back({make_compute_pass(gpu, shader, bindings_of(shader, pass, resources, pushed.back(), frame)),
                             {groups.at(0), groups.at(1), groups.at(2)}});
        }
    }
    submit(gpu, [&](const vk::raii::CommandBuffer& commands) {
        for (const Step& step : steps) {
            barrier(commands);
            if (step.groups.x * step.groups.y > 0) dispatch(commands, step.pass, step.groups);
        }
        barrier(commands);
    });
}

/// "(x, y)" of a ray's or hit's word.
std::string pixel_text(uint32_t word)
{
    return fmt::format("({}, {})", word & (MAX_IMAGE_PX - 1), (word >> PIXEL_BITS) & (MAX_IMAGE_PX - 1));
}

TraceStatus status_of(uint32_t word)
{
    return static_cast<TraceStatus>(number_to_status(static_cast<int>(word >> (2 * PIXEL_BITS))));
}

std::string hit_text(const uint32_t* hit)
{
    float t = 0;
    std::memcpy(&t, hit + 1, sizeof(t));
    const TraceStatus status = status_of(hit[0]);
    if (!has_place(status)) return std::string(status_name(status));
    return fmt::format("{} {} t {:.9g}", status_name(status), pixel_text(hit[0]), t);
}

/// Pixel and status in one word; t counts where there is a pixel.
bool same_hit(const uint32_t* a, const uint32_t* b)
{
    return a[0] == b[0] && (!has_place(status_of(a[0])) || a[1] == b[1]);
}

void compare_hits(FrameVerdict& verdict, const Words& rays, const Words& expected, const Words& answered)
{
    verdict.rays = expected.size() / hit_words;
    for (size_t i = 0; i < verdict.rays; ++i) {
        const uint32_t *right = &expected[i * hit_words], *given = &answered[i * hit_words];
        if (same_hit(right, given)) continue;
        if (verdict.differing++ > 0) continue;
        verdict.first = fmt::format("ray {} of pixel {}: {}, expected {}", i, pixel_text(rays[i * ray_words + 7]),
                                    hit_text(given), hit_text(right));
    }
}

uint32_t pixel_word(const std::array<uint32_t, ray_words>& ray) { return ray[7] & ((1U << (2 * PIXEL_BITS)) - 1); }

/// The ray set-up lists pixels in any order.
std::vector<std::array<uint32_t, ray_words>> by_pixel(const Words& words, size_t count)
{
    std::vector<std::array<uint32_t, ray_words>> rays(count);
    std::memcpy(rays.data(), words.data(), count * sizeof(rays[0]));
    std::ranges::sort(rays, {}, pixel_word);
    return rays;
}

/// Whether each ray of the frame is made. The set-up makes one at every pixel with a surface; a host asks the material, too.
void compare_set_up(FrameVerdict& verdict, const Words& rays, const Words& made, size_t count)
{
    verdict.set_up   = rays.size() / ray_words;
    const auto given = by_pixel(made, std::min(count, made.size() / ray_words));
    auto       next  = given.begin();
    for (const auto& ray : by_pixel(rays, verdict.set_up)) {
        while (next != given.end() && pixel_word(*next) < pixel_word(ray)) ++next;
        if (next != given.end() && *next == ray) continue;
        if (verdict.set_up_differing++ == 0 && verdict.first.empty())
            verdict.first = fmt::format("the ray of pixel {} is set up otherwise", pixel_text(ray[7]));
    }
}

FrameVerdict verify_frame(Gpu& gpu, const fs::path& folder, const fs::path& file)
{
    const json      frame     = json::parse(read_file(file));
    const Resources resources = make_resources(gpu, frame, folder / "frames");
    run_frame(gpu, frame, resources, folder);
    const auto read = [&](const std::string& name) {
        const Buffer& buffer = resources.buffers.at(name);
        return download_as<uint32_t>(gpu, buffer, frame.at("resources").at(name).at("bytes").get<size_t>() / 4);
    };
    FrameVerdict verdict{.frame = file.stem().string()};
    const Words  rays = read("rays");
    compare_hits(verdict, rays, read_words(folder / "expected" / frame.at("expected").at("hits").get<std::string>()),
                 read("hits"));
    if (frame.at("expected").contains("made_rays"))
        compare_set_up(verdict, read_words(folder / "frames" / frame.at("expected").at("made_rays").get<std::string>()),
                       read("made_rays"), read("made_count").at(0));
    return verdict;
}

} // namespace

std::vector<FrameVerdict> verify_export(Gpu& gpu, const fs::path& folder)
{
    std::vector<fs::path> files;
    if (fs::is_directory(folder / "frames"))
        for (const auto& entry : fs::directory_iterator(folder / "frames"))
            if (entry.path().extension() == ".json") files.push_back(entry.path());
    if (files.empty()) throw_spec_error("{}: no export: it has no frames/*.json", folder.string());
    std::ranges::sort(files);
    std::vector<FrameVerdict> verdicts;
    for (const fs::path& file : files) {
        try {
            verdicts.push_back(verify_frame(gpu, folder, file));
        } catch (const json::exception& error) {
            throw_spec_error("{}: {}", file.string(), error.what());
        } catch (const std::out_of_range&) {
            throw_spec_error("{}: names a resource that it does not list", file.string());
        }
    }
    return verdicts;
}

} // namespace ssrlab
