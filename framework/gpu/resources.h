// Buffers and images with their own memory, and the ways in and out of them.
#pragma once

#include "gpu/command_notes.h"

#include <glm/glm.hpp>

#include <cstring>
#include <span>

namespace ssrlab {

/// Returns the first allowed memory type (one bit each) with all wanted and preferred properties, else the first with
/// the wanted ones. Throws Failure if there is none.
uint32_t choose_memory_type(const vk::PhysicalDeviceMemoryProperties& properties, uint32_t allowed,
                            vk::MemoryPropertyFlags wanted, vk::MemoryPropertyFlags preferred);

/// Makes device-local storage for any use. Throws Failure when out of memory or over limits.
Buffer make_buffer(Gpu& gpu, uint64_t bytes, uint64_t item_bytes = sizeof(uint32_t));
/// Makes such a buffer that shaders may also read as texels of this format, where the device does so. Throws likewise.
Buffer make_texel_buffer(Gpu& gpu, uint64_t bytes, vk::Format format);
/// Makes another texel view, which must not outlive the buffer; null with plain buffers. Throws over limits.
vk::raii::BufferView make_texel_view(Gpu& gpu, const Buffer& buffer, vk::Format format);
/// Returns the descriptor type of a buffer of texels on this device.
vk::DescriptorType texel_descriptor(const Gpu& gpu);
void               upload(Gpu& gpu, Buffer& target, const void* data, uint64_t bytes);
void               download(Gpu& gpu, const Buffer& source, void* data, uint64_t bytes);

template <typename T> Buffer make_buffer_with(Gpu& gpu, std::span<const T> values)
{
    Buffer buffer = make_buffer(gpu, std::max<uint64_t>(values.size_bytes(), 16));
    if (!values.empty()) upload(gpu, buffer, values.data(), values.size_bytes());
    return buffer;
}

template <typename T> std::vector<T> download_as(Gpu& gpu, const Buffer& source, size_t count)
{
    std::vector<T> values(count);
    if (count > 0) download(gpu, source, values.data(), count * sizeof(T));
    return values;
}

struct GpuImage {
    vk::raii::DeviceMemory memory = nullptr;
    vk::raii::Image        image  = nullptr;
    vk::raii::ImageView    view   = nullptr;
    vk::Format             format = vk::Format::eUndefined;
    glm::ivec2             size_px{0, 0};
    uint32_t               levels = 1;
    uint32_t               layers = 1;
    uint64_t               id     = 0; // new_storage_id()
};

struct ImageOptions {
    vk::Format          format = vk::Format::eUndefined;
    glm::ivec2          size_px{0, 0};
    vk::ImageUsageFlags usage;
    uint32_t            levels     = 1;
    uint32_t            layers     = 1; // > 1: the view is an array view
    bool                array_view = false;
};
/// Makes an image in layout GENERAL, where it stays. Throws SpecError if the size exceeds the limit of the device.
GpuImage make_image(Gpu& gpu, const ImageOptions& options);
/// Makes an image of one level and layer that shaders load and store. Throws likewise.
GpuImage make_storage_image(Gpu& gpu, vk::Format format, glm::ivec2 size_px);
bool     is_depth(vk::Format format);

Storage storage_of(const Buffer& buffer);
Storage storage_of(const GpuImage& image);

/// Records setting every word of a buffer.
void record_fill(const Commands& commands, const Buffer& buffer, uint32_t word);

/// Copies tightly packed texels of level 0, layer 0.
void              upload(Gpu& gpu, GpuImage& target, const void* data, uint64_t bytes);
std::vector<char> download(Gpu& gpu, const GpuImage& source, uint32_t bytes_per_texel);

template <typename T> std::vector<T> download_as(Gpu& gpu, const GpuImage& source)
{
    const std::vector<char> bytes = download(gpu, source, sizeof(T));
    std::vector<T>          values(bytes.size() / sizeof(T));
    std::memcpy(static_cast<void*>(values.data()), bytes.data(), bytes.size());
    return values;
}

} // namespace ssrlab
