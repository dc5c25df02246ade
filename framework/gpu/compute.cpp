#include "gpu/compute.h"

#include "core/error.h"
#include "core/files.h"

#include <algorithm>
#include <span>

namespace ssrlab {
namespace {

vk::DescriptorType descriptor_type(BindingType type)
{
    switch (type) {
    case BindingType::storage_buffer: return vk::DescriptorType::eStorageBuffer;
    case BindingType::uniform_buffer: return vk::DescriptorType::eUniformBuffer;
    case BindingType::storage_image: return vk::DescriptorType::eStorageImage;
    case BindingType::sampled_image: return vk::DescriptorType::eCombinedImageSampler;
    case BindingType::texel_buffer: return vk::DescriptorType::eStorageTexelBuffer;
    }
    return vk::DescriptorType::eStorageBuffer;
}

void refuse_too_many(const Gpu& gpu, const Shader& shader)
{
    const auto& limits = gpu.impl->limits;
    const auto  refuse = [&](BindingType type, const char* what, uint32_t most) {
        const auto count =
            std::ranges::count(shader.bindings, type, [](const auto& binding) { return binding.second.type; });
        if (count > most)
            throw_failure("{}: {} {} are needed; the device '{}' allows {} a shader. Fewer layers need fewer",
                           shader.name, count, what, gpu.info.name, most);
    };
    refuse(BindingType::storage_image, "images", limits.maxPerStageDescriptorStorageImages);
    refuse(BindingType::storage_buffer, "storage buffers", limits.maxPerStageDescriptorStorageBuffers);
}

vk::raii::DescriptorSetLayout make_set_layout(Gpu& gpu, const Shader& shader)
{
    refuse_too_many(gpu, shader);
    std::vector<vk::DescriptorSetLayoutBinding> bindings;
    for (const auto& [name, binding] : shader.bindings)
        bindings.push_back({.binding         = binding.binding,
                            .descriptorType  = descriptor_type(binding.type),
                            .descriptorCount = 1,
                            .stageFlags      = vk::ShaderStageFlagBits::eCompute});
    return {gpu.impl->device, vk::DescriptorSetLayoutCreateInfo{.bindingCount = static_cast<uint32_t>(bindings.size()),
                                                                .pBindings    = bindings.data()}};
}

vk::raii::DescriptorPool make_pool(Gpu& gpu, const Shader& shader)
{
    std::map<vk::DescriptorType, uint32_t> counts;
    for (const auto& [name, binding] : shader.bindings) ++counts[descriptor_type(binding.type)];
    std::vector<vk::DescriptorPoolSize> sizes;
    for (const auto& [type, count] : counts) sizes.push_back({type, count});
    if (sizes.empty()) sizes.push_back({vk::DescriptorType::eStorageBuffer, 1});
    return {gpu.impl->device,
            vk::DescriptorPoolCreateInfo{.flags         = vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet,
                                         .maxSets       = 1,
                                         .poolSizeCount = static_cast<uint32_t>(sizes.size()),
                                         .pPoolSizes    = sizes.data()}};
}

void write_set(Gpu& gpu, const Shader& shader, const Bindings& bindings, const vk::raii::DescriptorSet& set)
{
    for (const auto& [name, binding] : shader.bindings) {
        const auto bound = bindings.find(name);
        if (bound == bindings.end())
            throw std::logic_error(fmt::format("{}: nothing is bound to '{}'", shader.name, name));
        const vk::DescriptorBufferInfo buffer{.buffer = bound->second.buffer, .offset = 0, .range = VK_WHOLE_SIZE};
        const vk::DescriptorImageInfo  image{.sampler     = bound->second.sampler,
                                             .imageView   = bound->second.view,
                                             .imageLayout = vk::ImageLayout::eGeneral};
        vk::WriteDescriptorSet         write{.dstSet          = *set,
                                             .dstBinding      = binding.binding,
                                             .descriptorCount = 1,
                                             .descriptorType  = descriptor_type(binding.type)};
        const bool                     is_texels = binding.type == BindingType::texel_buffer;
        const bool                     is_buffer =
            binding.type == BindingType::storage_buffer || binding.type == BindingType::uniform_buffer;
        if (is_texels ? !bound->second.texels : is_buffer != static_cast<bool>(bound->second.buffer))
            throw std::logic_error(fmt::format("{}: '{}' is bound to the wrong kind of resource", shader.name, name));
        if (is_texels)
            write.pTexelBufferView = &bound->second.texels;
        else if (is_buffer)
            write.pBufferInfo = &buffer;
        else
            write.pImageInfo = &image;
        gpu.impl->device.updateDescriptorSets(write, nullptr);
    }
}

vk::raii::Pipeline compile_pipeline(const GpuImpl& gpu, const Shader& shader, const Constants& constants,
                                    vk::PipelineLayout layout, vk::PipelineCreateFlags flags)
{
    try {
        const vk::raii::ShaderModule module(
            gpu.device, vk::ShaderModuleCreateInfo{.codeSize = shader.spirv.size() * 4, .pCode = shader.spirv.data()});
        const vk::SpecializationInfo specialization{.mapEntryCount = static_cast<uint32_t>(constants.entries.size()),
                                                    .pMapEntries   = constants.entries.data(),
                                                    .dataSize      = constants.bytes.size(),
                                                    .pData         = constants.bytes.data()};
        const vk::ComputePipelineCreateInfo info{.flags  = flags,
                                                 .stage  = {.stage               = vk::ShaderStageFlagBits::eCompute,
                                                            .module              = *module,
                                                            .pName               = "main",
                                                            .pSpecializationInfo = &specialization},
                                                 .layout = layout};
        return {gpu.device, gpu.pipeline_cache, info};
    } catch (const vk::SystemError& error) {
        throw_failure("{}: the driver refuses the pipeline: {}", shader.name, error.what());
    }
}

ComputePipeline make_pipeline(Gpu& gpu, const Shader& shader, const Constants& constants, uint32_t push_constant_bytes)
{
    const vk::raii::Device& device = gpu.impl->device;
    ComputePipeline         result;
    result.set_layout = make_set_layout(gpu, shader);
    const vk::PushConstantRange range{vk::ShaderStageFlagBits::eCompute, 0, push_constant_bytes};
    result.layout    = {device, vk::PipelineLayoutCreateInfo{.setLayoutCount         = 1,
                                                             .pSetLayouts            = &*result.set_layout,
                                                             .pushConstantRangeCount = push_constant_bytes > 0 ? 1U : 0U,
                                                             .pPushConstantRanges    = &range}};
    using Flag       = vk::PipelineCreateFlagBits;
    const auto flags = gpu.info.compiles_only ? Flag::eCaptureStatisticsKHR | Flag::eCaptureInternalRepresentationsKHR
                                              : vk::PipelineCreateFlags();
    result.pipeline =
        std::async(std::launch::async, compile_pipeline, std::cref(*gpu.impl), shader, constants, *result.layout, flags)
            .share();
    if (gpu.info.compiles_only) {
        result.compiled       = read_compiled(gpu, shader.name, result.pipeline.get());
        result.compiled.group = group_size(shader);
    }
    return result;
}

/// Made once for equal shaders and constants: runs of a sweep differ in few of their passes, and drivers compile slowly.
std::shared_ptr<const ComputePipeline> find_pipeline(Gpu& gpu, const Shader& shader, const Constants& constants,
                                                     uint32_t push_constant_bytes)
{
    constexpr size_t most = 256;
    std::string      key =
        fmt::format("{} {} {} ", shader.name,
                    content_hash({reinterpret_cast<const char*>(shader.spirv.data()), shader.spirv.size() * 4}),
                    push_constant_bytes);
    for (const vk::SpecializationMapEntry& entry : constants.entries) key += fmt::format("{} ", entry.constantID);
    key.append(constants.bytes.data(), constants.bytes.size());

    auto& known = gpu.impl->known_pipelines;
    auto  entry = known.find(key);
    if (entry == known.end()) {
        if (known.size() >= most)
            known.erase(std::ranges::min_element(known, {}, [](const auto& item) { return item.second.last_use; }));
        auto made = std::make_shared<const ComputePipeline>(make_pipeline(gpu, shader, constants, push_constant_bytes));
        entry     = known.emplace(std::move(key), GpuImpl::KnownPipeline{std::move(made)}).first;
        ++gpu.impl->pipelines_made;
    }
    entry->second.last_use = ++gpu.impl->pipeline_uses;
    return entry->second.pipeline;
}

/// What the code of a shader reads and writes of what is bound.
std::vector<StorageUse> uses_of(const Shader& shader, const Bindings& bindings)
{
    std::vector<StorageUse> uses;
    for (const auto& [name, binding] : shader.bindings)
        if (const auto bound = bindings.find(name); bound != bindings.end() && (binding.reads || binding.writes))
            uses.push_back({bound->second.storage, binding.reads, binding.writes, name});
    return uses;
}

} // namespace

Constants Constants::only(const std::set<uint32_t>& ids) const
{
    Constants result;
    for (vk::SpecializationMapEntry entry : entries) {
        if (!ids.contains(entry.constantID)) continue;
        const auto value = std::span(bytes).subspan(entry.offset, entry.size);
        entry.offset     = static_cast<uint32_t>(result.bytes.size());
        result.entries.push_back(entry);
        result.bytes.insert(result.bytes.end(), value.begin(), value.end());
    }
    return result;
}

ComputePass make_compute_pass(Gpu& gpu, const Shader& shader, const Bindings& bindings, const Constants& constants,
                              uint32_t push_constant_bytes)
{
    ComputePass pass;
    try {
        pass.compute = find_pipeline(gpu, shader, constants.only(shader.constants), push_constant_bytes);
        pass.uses    = uses_of(shader, bindings);
        if (gpu.info.compiles_only) {
            gpu.impl->asked_for.push_back(pass.compute);
            return pass;
        }
        pass.pool = make_pool(gpu, shader);
        vk::raii::DescriptorSets sets(
            gpu.impl->device,
            {.descriptorPool = *pass.pool, .descriptorSetCount = 1, .pSetLayouts = &*pass.compute->set_layout});
        pass.set = std::move(sets[0]);
    } catch (const vk::SystemError& error) {
        throw_failure("{}: the driver refuses the pipeline: {}", shader.name, error.what());
    }
    write_set(gpu, shader, bindings, pass.set);
    return pass;
}

namespace {
void bind(const Commands& commands, const ComputePass& pass)
{
    commands.bindPipeline(vk::PipelineBindPoint::eCompute, *pass.compute->pipeline.get());
    commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *pass.compute->layout, 0, *pass.set, nullptr);
}
} // namespace

void dispatch(const Commands& commands, const ComputePass& pass, glm::uvec3 groups)
{
    if (commands.noted != nullptr &&
        note(commands, {.uses = pass.uses, .pipeline = pass.compute.get(), .groups = groups}))
        return;
    bind(commands, pass);
    commands.dispatch(groups.x, groups.y, groups.z);
}

void dispatch_indirect(const Commands& commands, const ComputePass& pass, const Buffer& arguments)
{
    if (commands.noted != nullptr &&
        note(commands, {.uses = pass.uses, .pipeline = pass.compute.get(), .launch = &arguments}))
        return;
    bind(commands, pass);
    commands.dispatchIndirect(*arguments.buffer, 0);
}

Timestamps make_timestamps(Gpu& gpu, uint32_t count)
{
    if (gpu.info.compiles_only) return {};
    return {{gpu.impl->device, vk::QueryPoolCreateInfo{.queryType = vk::QueryType::eTimestamp, .queryCount = count}},
            count};
}

void write_timestamp(const Commands& commands, const Timestamps& timestamps, uint32_t index)
{
    if (index == 0) commands.resetQueryPool(*timestamps.pool, 0, timestamps.count);
    commands.writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, *timestamps.pool, index);
    // Where something was rasterised before, lavapipe takes the time at the next flush: it must come before the next pass.
    barrier(commands);
}

std::vector<double> read_intervals_ms(Gpu& gpu, const Timestamps& timestamps)
{
    const auto [result, ticks] = timestamps.pool.getResults<uint64_t>(
        0, timestamps.count, timestamps.count * sizeof(uint64_t), sizeof(uint64_t), vk::QueryResultFlagBits::e64);
    if (result != vk::Result::eSuccess) throw_failure("GPU timestamps are not available: {}", vk::to_string(result));
    std::vector<double> intervals;
    for (uint32_t i = 1; i < timestamps.count; ++i) {
        const uint64_t delta = (ticks[i] - ticks[i - 1]) & gpu.impl->timestamp_mask;
        intervals.push_back(static_cast<double>(delta) * gpu.impl->timestamp_period_ns * 1e-6);
    }
    return intervals;
}

} // namespace ssrlab
