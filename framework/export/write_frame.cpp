// One frame of the proof: its buffers as files, and a JSON file that says which pass gets which, and the dispatches.
#include "core/files.h"
#include "core/pixel_index.h"
#include "export/glsl.h"
#include "export/passes.h"
#include "shared.h"
#include "trace/lab_passes.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <set>

namespace ssrlab {
namespace {

using Json  = nlohmann::ordered_json;
using Words = std::vector<uint32_t>;

void write_words(const std::filesystem::path& path, const Words& words)
{
    write_file_atomically(path, {reinterpret_cast<const char*>(words.data()), words.size() * sizeof(uint32_t)});
}

/// The resources that the passes name, each with its content: a file, or one word that fills it.
Json resources(Gpu& gpu, const Lab& lab, const ComposedLab& composed, const ExportFrame& frame,
               std::span<const RayInput> rays, const std::set<std::string>& used, const std::filesystem::path& frames)
{
    const FrameWords words    = read_frame_words(gpu, lab);
    const auto       capacity = std::max<size_t>(rays.size(), 1);
    Json             all      = Json::object();
    const auto       file     = [&](const std::string& resource, const char* kind, const Words& content) {
        if (!used.contains(resource)) return;
        const std::string path = frame.name + "." + resource + ".bin";
        write_words(frames / path, content);
        all[resource] = {{"kind", kind}, {"bytes", content.size() * 4}, {"file", path}};
    };
    const auto room = [&](const std::string& resource, size_t bytes, uint32_t fill) {
        if (used.contains(resource)) all[resource] = {{"kind", "buffer"}, {"bytes", bytes}, {"fill", fill}};
    };
    file("view", "uniform", words.view);
    // As the frame has it: the lab's own says 0 of every depth that is no surface.
    const std::vector<float>& depth = frame.gbuffer.depth;
    Words                     depth_words(depth.size());
    std::ranges::transform(depth, depth_words.begin(), [](float value) { return std::bit_cast<uint32_t>(value); });
    file("host_depth", "buffer", depth_words);
    file("host_gradients", "buffer", words.gradients);
    room("cells", composed.depth_bytes, std::bit_cast<uint32_t>(static_cast<float>(BACKGROUND_DEPTH)));
    file("normals", "rgba32f", words.normals);
    file("solids", "r32f", words.solids);
    room("ray_count", 4, static_cast<uint32_t>(rays.size()));
    file("rays", "buffer", pack_rays(rays));
    room("hits", capacity * sizeof(PackedHit<float>), 0);
    for (const ComposedBuffer& buffer : composed.buffers) room(buffer.structure + "." + buffer.name, buffer.bytes, 0);
    // The ray set-up appends to a list of its own, which is then compared with the other one.
    room("made_count", 4, 0);
    room("made_rays", pixel_count(lab.gbuffer->view.size_px) * sizeof(PackedRay<float>), 0);
    return all;
}

Json dispatches(const ExportedPass& pass, size_t rays)
{
    Json all = Json::array();
    if (pass.pass.rays_per_workgroup > 0) {
        const glm::uvec3 groups =
            groups_in_rows(rays, static_cast<size_t>(pass.pass.rays_per_workgroup), LAUNCH_ROW_GROUPS);
        all.push_back({{"groups", {groups.x, groups.y, groups.z}}});
    }
    for (size_t i = 0; i < pass.pass.groups.size(); ++i) {
        const glm::uvec3 groups = pass.pass.groups[i];
        all.push_back({{"groups", {groups.x, groups.y, groups.z}}});
        if (!pass.pass.levels.empty()) all.back()["push"] = {pass.pass.levels[i].x, pass.pass.levels[i].y};
    }
    return all;
}

} // namespace

void write_frame(Gpu& gpu, const Lab& lab, const ComposedLab& composed, std::span<const ExportedPass> passes,
                 const ExportFrame& frame, std::span<const RayInput> rays, std::span<const RayOutcome> outcomes,
                 ExportLanguage language, const std::filesystem::path& folder)
{
    std::set<std::string> used;
    Json                  steps = Json::array();
    for (const ExportedPass& pass : passes) {
        if (pass.sets_up_rays && !frame.rays.empty()) continue; // they are given
        Json bindings = Json::object();
        for (const auto& [binding, resource] : pass.bindings) {
            const bool        own             = pass.sets_up_rays && (resource == "rays" || resource == "ray_count");
            const std::string name            = !own ? resource : resource == "rays" ? "made_rays" : "made_count";
            bindings[std::to_string(binding)] = name;
            used.insert(name);
        }
        steps.push_back({{"file", pass.name + file_ending(language)},
                         {"bindings", bindings},
                         {"dispatches", dispatches(pass, rays.size())}});
    }
    const glm::ivec2 size_px = lab.gbuffer->view.size_px;
    Json             json{{"what", frame.what},
              {"size_px", {size_px.x, size_px.y}},
              {"rays", rays.size()},
              {"resources", resources(gpu, lab, composed, frame, rays, used, folder / "frames")},
              {"push_binding", push_binding},
              {"passes", steps},
              {"expected", {{"hits", frame.name + ".bin"}}}};
    if (used.contains("made_rays"))
        json["expected"]["made_rays"] = frame.name + ".rays.bin"; // of frames/, in any order
    write_file_atomically(folder / "frames" / (frame.name + ".json"), json.dump(1) + "\n");
    write_words(folder / "expected" / (frame.name + ".bin"), pack_outcomes(outcomes));
}

} // namespace ssrlab
