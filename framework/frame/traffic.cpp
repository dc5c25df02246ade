// The bytes that the passes of a frame move, from their shaders, formats and dispatches.
#include "frame/frame_inputs.h"
#include "gpu/command_notes.h"
#include "shared.h"

#include <algorithm>
#include <numeric>

namespace ssrlab {
namespace {

uint64_t count_reflecting(const FrameInputs& frame)
{
    return frame.rays->capacity / static_cast<uint64_t>(frame.plan.values.at("rays_per_pixel"));
}

/// How many pixels or rays a dispatch is for whose size the device decides. A list that a pass makes of its own says
/// how many workgroups there are, in rows: those of the last row count as one.
uint64_t launched_items(Gpu& gpu, const FrameInputs& frame, const Buffer& launch, const std::string& pass)
{
    const bool of_tiles = &launch == &frame.lab->gbuffer->tiles.launch;
    if (of_tiles && pass != "rays") return count_reflecting(frame);
    if (gpu.info.compiles_only) return frame.rays->capacity; // as if every pixel reflected
    if (of_tiles || &launch == &frame.rays->launch || &launch == &frame.rays->group_launch)
        return download_as<uint32_t>(gpu, frame.rays->count, 1)[0];
    const glm::uvec3 groups = download_as<glm::uvec3>(gpu, launch, 1)[0];
    return uint64_t{RAYS_PER_GROUP} * (groups.y > 1 ? (groups.y - 1) * groups.x + 1 : groups.x);
}

uint64_t instructions_of(const Gpu& gpu, const FrameInputs& frame, const NotedCommand& command, uint64_t items)
{
    if (command.pipeline == nullptr) return 0;
    const CompiledPipeline& compiled = command.pipeline->compiled;
    const auto              found    = compiled.statistics.find("Instructions");
    if (found == compiled.statistics.end()) return 0;
    const auto each =
        static_cast<uint64_t>(command.launch == &frame.rays->group_launch ? rays_per_workgroup(gpu) : RAYS_PER_GROUP);
    const uint64_t groups = command.launch != nullptr
                                ? (items + each - 1) / each
                                : uint64_t{command.groups.x} * command.groups.y * command.groups.z;
    return found->second * groups * compiled.group;
}

/// What one pass reads and writes of each buffer and image, at most all of it.
struct Moved {
    std::map<uint64_t, uint64_t> read, written; // bytes by Storage::id

    void add(const StorageUse& use, uint64_t bytes)
    {
        // What the pass wrote itself is still in an ideal cache.
        if (use.reads && !written.contains(use.of.id)) read[use.of.id] = std::max(read[use.of.id], bytes);
        if (use.writes) written[use.of.id] = std::max(written[use.of.id], bytes);
    }
};

uint64_t total_of(const std::map<uint64_t, uint64_t>& bytes)
{
    return std::accumulate(bytes.begin(), bytes.end(), uint64_t{0},
                           [](uint64_t sum, const auto& entry) { return sum + entry.second; });
}

} // namespace

PassTraffic sum_of(std::span<const PassTraffic> passes)
{
    PassTraffic sum{"frame"};
    for (const PassTraffic& pass : passes) {
        sum.read_bytes += pass.read_bytes;
        sum.written_bytes += pass.written_bytes;
        sum.instructions += pass.instructions;
    }
    return sum;
}

double least_ms(const PassTraffic& traffic, double bandwidth_gbps)
{
    return static_cast<double>(traffic.read_bytes + traffic.written_bytes) / (bandwidth_gbps * 1e6);
}

std::vector<PassTraffic> count_traffic(Gpu& gpu, const ReadyFrame& frame)
{
    const FrameInputs&       inputs = frame.inputs;
    std::vector<PassTraffic> passes;
    auto                     record = frame.record_functions.begin();
    for (const PlannedPass& planned : inputs.plan.passes) {
        if (!planned.runs) continue;
        PassTraffic traffic{planned.id};
        Moved       moved;
        for (const NotedCommand& command : note_commands(gpu, *record++)) {
            const bool     whole = command.launch == nullptr;
            const uint64_t items = whole ? 0 : launched_items(gpu, inputs, *command.launch, planned.id);
            for (const StorageUse& use : command.uses) {
                const bool     part  = std::ranges::count(planned.pass->read_of_reflectors, use.name) > 0;
                const uint64_t count = part ? count_reflecting(inputs) : items;
                moved.add(use, whole && !part ? use.of.bytes : std::min(use.of.bytes, count * use.of.item_bytes));
            }
            traffic.instructions += instructions_of(gpu, inputs, command, items);
        }
        traffic.read_bytes    = total_of(moved.read);
        traffic.written_bytes = total_of(moved.written);
        passes.push_back(traffic);
    }
    return passes;
}

} // namespace ssrlab
