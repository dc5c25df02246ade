#include "gpu/resources.h"

#include "core/error.h"
#include "core/pixel_index.h"

#include <vulkan/vulkan_format_traits.hpp>

namespace ssrlab {
namespace {

using Property = vk::MemoryPropertyFlagBits;

vk::raii::DeviceMemory allocate(const GpuImpl& impl, const vk::MemoryRequirements& needs,
                                vk::MemoryPropertyFlags wanted, vk::MemoryPropertyFlags preferred = {})
{
    const auto properties = impl.physical_device.getMemoryProperties();
    const auto type       = choose_memory_type(properties, needs.memoryTypeBits, wanted, preferred);
    try {
        return {impl.device, vk::MemoryAllocateInfo{.allocationSize = needs.size, .memoryTypeIndex = type}};
    } catch (const vk::SystemError& error) {
        throw_failure("{} MiB of device memory cannot be had: {}", needs.size >> 20, error.what());
    }
}

Buffer make(Gpu& gpu, uint64_t bytes, vk::BufferUsageFlags usage, vk::MemoryPropertyFlags wanted,
            vk::MemoryPropertyFlags preferred = {})
{
    Buffer result;
    result.bytes = bytes;
    result.id    = new_storage_id(gpu);
    if (gpu.info.compiles_only) return result;
    result.buffer = {gpu.impl->device, vk::BufferCreateInfo{.size = bytes, .usage = usage}};
    result.memory = allocate(*gpu.impl, result.buffer.getMemoryRequirements(), wanted, preferred);
    result.buffer.bindMemory(*result.memory, 0);
    return result;
}

void refuse_too_many_texels(const Gpu& gpu, uint64_t bytes, vk::Format format)
{
    const uint64_t most_bytes = gpu.impl->limits.maxStorageBufferRange;
    if (gpu.info.plain_buffers && bytes > most_bytes)
        throw_failure("a buffer of {} MiB is needed; the device allows {} MiB", bytes >> 20, most_bytes >> 20);
    if (gpu.info.plain_buffers) return;
    const uint64_t texels = bytes / vk::blockSize(format), most = gpu.impl->limits.maxTexelBufferElements;
    if (texels > most) throw_failure("a buffer of {} texels is needed; the device allows {}", texels, most);
}

using Usage                            = vk::BufferUsageFlagBits;
constexpr vk::BufferUsageFlags any_use = Usage::eStorageBuffer | Usage::eUniformBuffer | Usage::eIndirectBuffer |
                                         Usage::eVertexBuffer | Usage::eIndexBuffer | Usage::eTransferSrc |
                                         Usage::eTransferDst;

Buffer map(Buffer buffer)
{
    if (!*buffer.memory) throw_failure("a device that only compiles was asked for what is in its memory");
    buffer.mapped = buffer.memory.mapMemory(0, buffer.bytes);
    return buffer;
}

Buffer make_upload_buffer(Gpu& gpu, uint64_t bytes)
{
    return map(make(gpu, bytes, Usage::eTransferSrc, Property::eHostVisible | Property::eHostCoherent));
}

/// Memory that the CPU caches, where there is such: reads of other memory go to the bus one by one.
Buffer make_download_buffer(Gpu& gpu, uint64_t bytes)
{
    return map(
        make(gpu, bytes, Usage::eTransferDst, Property::eHostVisible | Property::eHostCoherent, Property::eHostCached));
}

/// Calls use(buffer) with at least that many bytes that the host sees. A large one is not kept.
template <typename Use> void with_staging(Gpu& gpu, Buffer& kept, auto make_staging, uint64_t bytes, const Use& use)
{
    constexpr uint64_t most_kept_bytes = 64ULL << 20;
    if (kept.bytes < bytes) {
        kept = {};
        kept = make_staging(gpu, std::max<uint64_t>(bytes, 1 << 16));
    }
    use(kept);
    if (kept.bytes > most_kept_bytes) kept = {};
}

template <typename Record> void submit_copy(Gpu& gpu, const Buffer& staging, const Record& record)
{
    submit(gpu, [&](const Commands& commands) {
        barrier(commands);
        record(commands, *staging.buffer);
        barrier(commands);
    });
}

template <typename Record> void submit_upload(Gpu& gpu, const void* data, uint64_t bytes, const Record& record)
{
    with_staging(gpu, gpu.impl->upload_staging, make_upload_buffer, bytes, [&](const Buffer& staging) {
        std::memcpy(staging.mapped, data, bytes);
        submit_copy(gpu, staging, record);
    });
}

template <typename Record> void submit_download(Gpu& gpu, void* data, uint64_t bytes, const Record& record)
{
    with_staging(gpu, gpu.impl->download_staging, make_download_buffer, bytes, [&](const Buffer& staging) {
        submit_copy(gpu, staging, record);
        std::memcpy(data, staging.mapped, bytes);
    });
}

vk::ImageAspectFlags aspect_of(vk::Format format)
{
    return is_depth(format) ? vk::ImageAspectFlagBits::eDepth : vk::ImageAspectFlagBits::eColor;
}

vk::BufferImageCopy whole_image(const GpuImage& image)
{
    return {.imageSubresource = {aspect_of(image.format), 0, 0, 1},
            .imageExtent      = {static_cast<uint32_t>(image.size_px.x), static_cast<uint32_t>(image.size_px.y), 1}};
}

} // namespace

uint32_t choose_memory_type(const vk::PhysicalDeviceMemoryProperties& properties, uint32_t allowed,
                            vk::MemoryPropertyFlags wanted, vk::MemoryPropertyFlags preferred)
{
    for (const vk::MemoryPropertyFlags flags : {wanted | preferred, wanted})
        for (uint32_t i = 0; i < properties.memoryTypeCount; ++i)
            if ((allowed & (1U << i)) != 0 && (properties.memoryTypes[i].propertyFlags & flags) == flags) return i;
    throw_failure("the device has no memory type with {}", vk::to_string(wanted));
}

Buffer make_buffer(Gpu& gpu, uint64_t bytes, uint64_t item_bytes)
{
    Buffer buffer     = make(gpu, bytes, any_use, Property::eDeviceLocal);
    buffer.item_bytes = item_bytes;
    return buffer;
}

Buffer make_texel_buffer(Gpu& gpu, uint64_t bytes, vk::Format format)
{
    refuse_too_many_texels(gpu, bytes, format); // before its memory is asked for
    Buffer buffer = make(gpu, bytes, any_use | vk::BufferUsageFlagBits::eStorageTexelBuffer, Property::eDeviceLocal);
    buffer.texels = make_texel_view(gpu, buffer, format);
    buffer.item_bytes = vk::blockSize(format);
    return buffer;
}

vk::raii::BufferView make_texel_view(Gpu& gpu, const Buffer& buffer, vk::Format format)
{
    refuse_too_many_texels(gpu, buffer.bytes, format);
    if (gpu.info.plain_buffers || gpu.info.compiles_only) return nullptr;
    return {gpu.impl->device,
            vk::BufferViewCreateInfo{.buffer = *buffer.buffer, .format = format, .range = VK_WHOLE_SIZE}};
}

vk::DescriptorType texel_descriptor(const Gpu& gpu)
{
    return gpu.info.plain_buffers ? vk::DescriptorType::eStorageBuffer : vk::DescriptorType::eStorageTexelBuffer;
}

void upload(Gpu& gpu, Buffer& target, const void* data, uint64_t bytes)
{
    if (bytes == 0 || gpu.info.compiles_only) return;
    submit_upload(gpu, data, bytes, [&](const Commands& commands, vk::Buffer staging) {
        commands.copyBuffer(staging, *target.buffer, vk::BufferCopy{.size = bytes});
    });
}

void download(Gpu& gpu, const Buffer& source, void* data, uint64_t bytes)
{
    if (bytes == 0) return;
    submit_download(gpu, data, bytes, [&](const Commands& commands, vk::Buffer staging) {
        commands.copyBuffer(*source.buffer, staging, vk::BufferCopy{.size = bytes});
    });
}

bool is_depth(vk::Format format) { return format == vk::Format::eD32Sfloat || format == vk::Format::eD16Unorm; }

Storage storage_of(const Buffer& buffer) { return {buffer.id, buffer.bytes, buffer.item_bytes}; }

Storage storage_of(const GpuImage& image)
{
    const uint64_t texel = vk::blockSize(image.format);
    uint64_t       count = 0;
    for (uint32_t level = 0; level < image.levels; ++level)
        count += pixel_count(glm::max(image.size_px >> static_cast<int>(level), 1));
    return {image.id, count * image.layers * texel, texel};
}

void record_fill(const Commands& commands, const Buffer& buffer, uint32_t word)
{
    if (note(commands, {.uses = {{storage_of(buffer), false, true}}})) return;
    commands.fillBuffer(*buffer.buffer, 0, VK_WHOLE_SIZE, word);
}

GpuImage make_image(Gpu& gpu, const ImageOptions& options)
{
    using ImageUsage = vk::ImageUsageFlagBits;
    const bool drawn =
        static_cast<bool>(options.usage & (ImageUsage::eColorAttachment | ImageUsage::eDepthStencilAttachment));
    const auto limit = static_cast<int>(drawn ? gpu.info.max_drawn_px : gpu.impl->limits.maxImageDimension2D);
    if (options.size_px.x < 1 || options.size_px.y < 1 || options.size_px.x > limit || options.size_px.y > limit)
        throw_spec_error("image size {}x{} is outside what the device '{}' {}: 1x1 to {}x{}", options.size_px.x,
                         options.size_px.y, gpu.info.name, drawn ? "can draw" : "supports", limit, limit);
    GpuImage result;
    result.format  = options.format;
    result.size_px = options.size_px;
    result.levels  = options.levels;
    result.layers  = options.layers;
    result.id      = new_storage_id(gpu);
    if (gpu.info.compiles_only) return result;
    const vk::ImageCreateInfo info{
        .imageType   = vk::ImageType::e2D,
        .format      = options.format,
        .extent      = {static_cast<uint32_t>(options.size_px.x), static_cast<uint32_t>(options.size_px.y), 1},
        .mipLevels   = options.levels,
        .arrayLayers = options.layers,
        .samples     = vk::SampleCountFlagBits::e1,
        .usage       = options.usage | vk::ImageUsageFlagBits::eTransferSrc | vk::ImageUsageFlagBits::eTransferDst};
    result.image  = {gpu.impl->device, info};
    result.memory = allocate(*gpu.impl, result.image.getMemoryRequirements(), Property::eDeviceLocal);
    result.image.bindMemory(*result.memory, 0);
    const vk::ImageSubresourceRange all{aspect_of(options.format), 0, options.levels, 0, options.layers};
    result.view = {
        gpu.impl->device,
        vk::ImageViewCreateInfo{.image    = *result.image,
                                .viewType = options.array_view ? vk::ImageViewType::e2DArray : vk::ImageViewType::e2D,
                                .format   = options.format,
                                .subresourceRange = all}};
    submit(gpu, [&](const Commands& commands) {
        const vk::ImageMemoryBarrier2 to_general{.srcStageMask  = vk::PipelineStageFlagBits2::eNone,
                                                 .dstStageMask  = vk::PipelineStageFlagBits2::eAllCommands,
                                                 .dstAccessMask = vk::AccessFlagBits2::eMemoryRead |
                                                                  vk::AccessFlagBits2::eMemoryWrite,
                                                 .oldLayout        = vk::ImageLayout::eUndefined,
                                                 .newLayout        = vk::ImageLayout::eGeneral,
                                                 .image            = *result.image,
                                                 .subresourceRange = all};
        commands.pipelineBarrier2(
            vk::DependencyInfo{.imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &to_general});
    });
    return result;
}

GpuImage make_storage_image(Gpu& gpu, vk::Format format, glm::ivec2 size_px)
{
    return make_image(gpu, {.format = format, .size_px = size_px, .usage = vk::ImageUsageFlagBits::eStorage});
}

void upload(Gpu& gpu, GpuImage& target, const void* data, uint64_t bytes)
{
    if (gpu.info.compiles_only) return;
    submit_upload(gpu, data, bytes, [&](const Commands& commands, vk::Buffer staging) {
        commands.copyBufferToImage(staging, *target.image, vk::ImageLayout::eGeneral, whole_image(target));
    });
}

std::vector<char> download(Gpu& gpu, const GpuImage& source, uint32_t bytes_per_texel)
{
    std::vector<char> texels(pixel_count(source.size_px) * bytes_per_texel);
    submit_download(gpu, texels.data(), texels.size(), [&](const Commands& commands, vk::Buffer staging) {
        commands.copyImageToBuffer(*source.image, vk::ImageLayout::eGeneral, staging, whole_image(source));
    });
    return texels;
}

} // namespace ssrlab
