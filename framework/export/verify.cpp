// A host for exported passes: it reads a frame's JSON file, runs the passes that it lists, and compares. It knows nothing of the lab.
#include "core/error.h"
#include "core/files.h"
#include "export/answers.h"
#include "gpu/compute.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <deque>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

void require_known_language(const fs::path& file)
{
    if (file.extension() != ".comp" && file.extension() != ".hlsl")
        throw_spec_error("{}: expected .comp (GLSL) or .hlsl; other languages are not run here", file.string());
}

struct Resources {
    std::map<std::string, Buffer>   buffers;
    std::map<std::string, GpuImage> images;
    vk::raii::Sampler               sampler = nullptr; // of images that HLSL reads as textures
};

Resources make_resources(Gpu& gpu, const json& frame, const fs::path& frames)
{
    Resources        made{.buffers = {}, .images = {}, .sampler = {gpu.impl->device, vk::SamplerCreateInfo{}}};
    const glm::ivec2 size_px(frame.at("size_px").at(0), frame.at("size_px").at(1));
    for (const auto& [name, resource] : frame.at("resources").items()) {
        const size_t bytes     = resource.at("bytes");
        const Words  words     = resource.contains("file") ? read_words(frames / resource.at("file").get<std::string>())
                                                           : Words(bytes / sizeof(uint32_t), resource.at("fill"));
        const std::string kind = resource.at("kind");
        if (kind == "buffer" || kind == "uniform") {
            const auto buffer = made.buffers.emplace(name, make_buffer(gpu, std::max<size_t>(bytes, 16))).first;
            if (!words.empty()) upload(gpu, buffer->second, words.data(), words.size() * sizeof(uint32_t));
        } else {
            const auto format = kind == "r32f" ? vk::Format::eR32Sfloat : vk::Format::eR32G32B32A32Sfloat;
            GpuImage   image =
                make_image(gpu, {.format  = format,
                                 .size_px = size_px,
                                 .usage   = vk::ImageUsageFlagBits::eStorage | vk::ImageUsageFlagBits::eSampled});
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
            bindings.insert({name, {image->second, resources.sampler}});
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
    const ShaderFilesHeld held(gpu);
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
    submit(gpu, [&](const Commands& commands) {
        for (const Step& step : steps) {
            barrier(commands);
            if (step.groups.x * step.groups.y > 0) dispatch(commands, step.pass, step.groups);
        }
        barrier(commands);
    });
}

FrameVerdict verify_frame(Gpu& gpu, const fs::path& folder, const fs::path& file)
{
    const json frame = json::parse(read_file(file));
    require_sizes(frame, file);
    const Resources resources = make_resources(gpu, frame, folder / "frames");
    run_frame(gpu, frame, resources, folder);
    const auto read = [&](const std::string& name) {
        const Buffer& buffer = resources.buffers.at(name);
        return download_as<uint32_t>(gpu, buffer, frame.at("resources").at(name).at("bytes").get<size_t>() / 4);
    };
    Answers answers{.hits = read("hits")};
    if (frame.at("expected").contains("made_rays")) {
        answers.made_rays  = read("made_rays");
        answers.made_count = read("made_count").at(0);
    }
    return compare_answers(frame, file, answers);
}

} // namespace

std::vector<FrameVerdict> verify_export(Gpu& gpu, const fs::path& folder)
{
    std::vector<FrameVerdict> verdicts;
    for_each_frame(folder, [&](const fs::path& file) { verdicts.push_back(verify_frame(gpu, folder, file)); });
    return verdicts;
}

} // namespace ssrlab
