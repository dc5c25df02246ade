#include "gpu/compiled.h"

#include "core/error.h"
#include "core/names.h"
#include "gpu/vulkan.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>

namespace ssrlab {
namespace {

constexpr auto chips = std::to_array<const char*>({"navi21", "navi10", "gfx1100", "vega10"});

std::string_view trimmed(std::string_view text)
{
    const size_t first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t\r");
    return first == std::string_view::npos ? "" : text.substr(first, last - first + 1);
}

bool is_load(std::string_view instruction)
{
    constexpr auto begins = std::to_array<std::string_view>(
        {"buffer_load", "tbuffer_load", "image_load", "image_sample", "image_gather", "global_load", "flat_load"});
    return std::ranges::any_of(begins, [&](std::string_view begin) { return instruction.starts_with(begin); });
}

struct Loop {
    size_t first = 0, end = 0; // of the instructions
};

} // namespace

std::vector<std::string> known_chips() { return {chips.begin(), chips.end()}; }

void pretend_chip(const std::string& chip)
{
    if (std::ranges::find(chips, chip) == chips.end())
        throw_spec_error("--chip: {}", unknown_name("chip", chip, known_chips()));
    for (const char* folder : {"/etc/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/usr/share/vulkan/icd.d"}) {
        std::error_code none;
        for (const auto& file : std::filesystem::directory_iterator(folder, none)) {
            if (!file.path().filename().string().starts_with("radeon_icd.")) continue;
            ::setenv("RADV_FORCE_FAMILY", chip.c_str(), 1);
            ::setenv("VK_ICD_FILENAMES", file.path().c_str(), 1);
            ::unsetenv("VK_DRIVER_FILES"); // would come before
            return;
        }
    }
    throw_failure("--chip {}: Mesa's driver for AMD GPUs is not installed: no /usr/share/vulkan/icd.d/radeon_icd.*. "
                  "Debian: install mesa-vulkan-drivers",
                  chip);
}

CompiledPipeline read_compiled(const Gpu& gpu, const std::string& shader, const vk::raii::Pipeline& pipeline)
{
    const vk::raii::Device& device = gpu.impl->device;
    CompiledPipeline        compiled{.shader = shader, .group = 0, .lanes = 0, .statistics = {}, .assembly = {}};
    const auto              executables = device.getPipelineExecutablePropertiesKHR({.pipeline = *pipeline});
    if (executables.empty()) throw_failure("{}: the driver says nothing about what it compiled", shader);
    compiled.lanes = executables[0].subgroupSize;
    const vk::PipelineExecutableInfoKHR first{.pipeline = *pipeline, .executableIndex = 0};
    using Format = vk::PipelineExecutableStatisticFormatKHR;
    for (const auto& statistic : device.getPipelineExecutableStatisticsKHR(first))
        if (statistic.format == Format::eUint64)
            compiled.statistics[statistic.name.data()] = statistic.value.u64;
        else if (statistic.format == Format::eInt64 && statistic.value.i64 >= 0)
            compiled.statistics[statistic.name.data()] = static_cast<uint64_t>(statistic.value.i64);

    // By hand: the wrapper has no room for the texts.
    const VkPipelineExecutableInfoKHR& plain    = first;
    const auto*                        call     = device.getDispatcher();
    uint32_t                           count    = 0;
    const auto                         read_all = [&](VkPipelineExecutableInternalRepresentationKHR* texts) {
        if (call->vkGetPipelineExecutableInternalRepresentationsKHR(*device, &plain, &count, texts) < 0)
            throw_failure("{}: the driver does not show what it compiled", shader);
    };
    read_all(nullptr);
    std::vector<VkPipelineExecutableInternalRepresentationKHR> texts(
        count,
        {VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INTERNAL_REPRESENTATION_KHR, nullptr, {}, {}, VK_FALSE, 0, nullptr});
    read_all(texts.data());
    std::vector<std::string> room;
    for (auto& text : texts) {
        room.emplace_back(text.dataSize, '\0');
        text.pData = room.back().data();
    }
    read_all(texts.data());
    for (const auto& text : texts)
        if (text.isText != VK_FALSE && std::string_view(text.name) == "Assembly")
            compiled.assembly = std::string(static_cast<const char*>(text.pData));
    return compiled;
}

std::vector<CompiledPtr> take_compiled(Gpu& gpu)
{
    std::vector<CompiledPtr> all;
    for (const auto& pipeline : gpu.impl->asked_for) {
        CompiledPtr compiled(pipeline, &pipeline->compiled);
        if (std::ranges::find(all, compiled) == all.end()) all.push_back(std::move(compiled));
    }
    gpu.impl->asked_for.clear();
    return all;
}

LoopCode innermost_loop(std::string_view assembly)
{
    std::map<std::string_view, size_t> begins; // of blocks: their first instruction
    std::vector<std::string_view>      instructions;
    std::vector<Loop>                  loops;
    while (!assembly.empty()) {
        const size_t           end  = std::min(assembly.find('\n'), assembly.size());
        const std::string_view line = trimmed(assembly.substr(0, assembly.find_first_of(";\n")));
        assembly.remove_prefix(std::min(end + 1, assembly.size()));
        if (line.empty()) continue;
        if (line.ends_with(':')) {
            begins[line.substr(0, line.size() - 1)] = instructions.size();
            continue;
        }
        instructions.push_back(line);
        if (!line.starts_with("s_branch") && !line.starts_with("s_cbranch")) continue;
        const auto target = begins.find(trimmed(line.substr(std::min(line.find(' '), line.size()))));
        if (target == begins.end()) continue;
        // Several ways back to the same block are one loop.
        const auto known = std::ranges::find(loops, target->second, &Loop::first);
        if (known != loops.end())
            known->end = instructions.size();
        else
            loops.push_back({target->second, instructions.size()});
    }
    LoopCode longest;
    for (const Loop& loop : loops) {
        const bool has_inner = std::ranges::any_of(loops, [&](const Loop& other) {
            return other.first >= loop.first && other.end <= loop.end &&
                   other.end - other.first < loop.end - loop.first;
        });
        if (has_inner || static_cast<int>(loop.end - loop.first) <= longest.instructions) continue;
        longest = {static_cast<int>(loop.end - loop.first), 0};
        for (size_t i = loop.first; i < loop.end; ++i) longest.loads += is_load(instructions[i]);
    }
    return longest;
}

} // namespace ssrlab
