// A compute pass: a shader, its constants, and the resources bound to its names.
#pragma once

#include "gpu/resources.h"
#include "gpu/shader.h"

namespace ssrlab {

/// Specialization constants by constant_id, of the types that the shader declares.
class Constants {
public:
    void add(uint32_t id, int32_t value) { append(id, value); }
    void add(uint32_t id, float value) { append(id, value); }
    void add(uint32_t id, double value) { append(id, value); }

    /// Returns those with these ids.
    Constants only(const std::set<uint32_t>& ids) const;

    std::vector<vk::SpecializationMapEntry> entries;
    std::vector<char>                       bytes;

private:
    template <typename T> void append(uint32_t id, T value)
    {
        entries.push_back({.constantID = id, .offset = static_cast<uint32_t>(bytes.size()), .size = sizeof(T)});
        const char* begin = reinterpret_cast<const char*>(&value);
        bytes.insert(bytes.end(), begin, begin + sizeof(T));
    }
};

/// A resource that a name of a shader can be bound to.
struct Bound {
    vk::Buffer     buffer;
    vk::BufferView texels;
    vk::ImageView  view;
    vk::Sampler    sampler;

    Storage storage;

    Bound(const Buffer& b) : buffer(*b.buffer), texels(*b.texels), storage(storage_of(b)) {}
    /// A part of a buffer, or all of it, as texels.
    Bound(const Buffer& b, const vk::raii::BufferView& t, const Storage& s) : buffer(*b.buffer), texels(*t), storage(s)
    {
    }
    Bound(const GpuImage& image) : view(*image.view), storage(storage_of(image)) {}
    Bound(const GpuImage& image, const vk::raii::Sampler& s) : view(*image.view), sampler(*s) {}
};
using Bindings = std::map<std::string, Bound>;

struct ComputePass {
    std::shared_ptr<const ComputePipeline> compute; // shared by all passes of the same shader and constants
    vk::raii::DescriptorPool               pool = nullptr;
    vk::raii::DescriptorSet                set  = nullptr;
    std::vector<StorageUse>                uses = {}; // of buffers and images; not what is sampled, and no uniforms
};

/// Makes a pass. Throws std::logic_error if `bindings` lacks a name that the shader uses; unused names and constants
/// are ignored, so passes that differ only in those share a pipeline. push_constant_bytes > 0 adds one push-constant
/// block.
ComputePass make_compute_pass(Gpu& gpu, const Shader& shader, const Bindings& bindings, const Constants& constants = {},
                              uint32_t push_constant_bytes = 0);

/// Returns the workgroups of 8 x 8 that cover an image.
inline glm::uvec3 groups_of_8(glm::ivec2 size_px)
{
    return {static_cast<uint32_t>(size_px.x + 7) / 8, static_cast<uint32_t>(size_px.y + 7) / 8, 1};
}

/// Returns the workgroups for a list of items, in rows of `row_groups`: devices limit how long a row may be.
inline glm::uvec3 groups_in_rows(size_t items, size_t items_per_group, uint32_t row_groups)
{
    const auto groups = static_cast<uint32_t>((items + items_per_group - 1) / items_per_group);
    return {std::min(groups, row_groups), (groups + row_groups - 1) / row_groups, 1};
}

void dispatch(const Commands& commands, const ComputePass& pass, glm::uvec3 groups);
void dispatch_indirect(const Commands& commands, const ComputePass& pass, const Buffer& arguments);
template <typename T> void push(const Commands& commands, const ComputePass& pass, const T& value)
{
    if (commands.noted != nullptr) return;
    commands.pushConstants<T>(*pass.compute->layout, vk::ShaderStageFlagBits::eCompute, 0, value);
}

/// GPU timestamps between passes.
struct Timestamps {
    vk::raii::QueryPool pool  = nullptr;
    uint32_t            count = 0;
};
Timestamps make_timestamps(Gpu& gpu, uint32_t count);
void       write_timestamp(const Commands& commands, const Timestamps& timestamps, uint32_t index);
/// Returns the milliseconds between neighbouring timestamps. Throws Failure if a value is missing.
std::vector<double> read_intervals_ms(Gpu& gpu, const Timestamps& timestamps);

} // namespace ssrlab
