// The inside of Gpu: for the folders gpu/, trace/ and frame/ only.
#pragma once

#include "gpu/compiled.h"
#include "gpu/shader.h"

#include <vulkan/vulkan_raii.hpp>

#include <atomic>
#include <functional>
#include <future>
#include <map>
#include <mutex>

namespace ssrlab {

/// A compute shader with its constants, to which anything can be bound.
struct ComputePipeline {
    vk::raii::DescriptorSetLayout          set_layout = nullptr;
    vk::raii::PipelineLayout               layout     = nullptr;
    std::shared_future<vk::raii::Pipeline> pipeline;      // compiled on a thread of its own: drivers compile slowly
    CompiledPipeline                       compiled = {}; // of a device that only compiles
};

struct Buffer {
    vk::raii::DeviceMemory memory     = nullptr; // freed after the buffer: members die in reverse order
    vk::raii::Buffer       buffer     = nullptr;
    vk::raii::BufferView   texels     = nullptr; // make_texel_buffer() only
    uint64_t               bytes      = 0;
    void*                  mapped     = nullptr;          // host-visible buffers only
    uint64_t               id         = 0;                // new_storage_id()
    uint64_t               item_bytes = sizeof(uint32_t); // what an invocation reads or writes of it at least
};

struct NotedCommand;
/// Commands that are being recorded. Where `noted` is set they are listed there instead (gpu/command_notes.h).
struct Commands : vk::raii::CommandBuffer {
    explicit Commands(vk::raii::CommandBuffer buffer) : vk::raii::CommandBuffer(std::move(buffer)) {}
    std::vector<NotedCommand>* noted = nullptr;
};

struct GpuImpl {
    GpuImpl() = default;
    ~GpuImpl(); // keeps the pipelines that were compiled for the next start
    GpuImpl(const GpuImpl&)            = delete;
    GpuImpl& operator=(const GpuImpl&) = delete;

    vk::raii::Context                context;
    vk::raii::Instance               instance        = nullptr;
    vk::raii::DebugUtilsMessengerEXT messenger       = nullptr;
    vk::raii::PhysicalDevice         physical_device = nullptr;
    vk::raii::Device                 device          = nullptr;
    vk::raii::Queue                  queue           = nullptr;
    vk::raii::CommandPool            command_pool    = nullptr;
    vk::raii::PipelineCache          pipeline_cache  = nullptr;
    std::string                      pipeline_cache_name;      // on disk
    size_t                           pipeline_cache_bytes = 0; // as read from there
    uint32_t                         queue_family         = 0;
    vk::PhysicalDeviceLimits         limits;
    double                           timestamp_period_ns = 1;
    uint64_t                         timestamp_mask      = ~0ULL;
    Buffer                           upload_staging, download_staging; // kept, since host memory is slow to get
    std::mutex                       messages_mutex;
    std::vector<std::string>         messages;

    /// Pipelines by shader and constants; the least recently used one is dropped when there are too many.
    struct KnownPipeline {
        std::shared_ptr<const ComputePipeline> pipeline;
        uint64_t                               last_use = 0;
    };
    std::map<std::string, KnownPipeline>                known_pipelines;
    uint64_t                                            pipeline_uses  = 0;
    size_t                                              pipelines_made = 0;
    std::vector<std::shared_ptr<const ComputePipeline>> asked_for;    // by passes, of a device that only compiles
    std::atomic<uint64_t>                               storages = 0; // made so far

    /// Compiled shaders by their source, and what was seen of the files since the last look.
    struct KnownShaders {
        std::mutex                                                mutex;
        std::map<std::string, Shader>                             compiled;
        int                                                       holders = 0; // ShaderFilesHeld
        std::map<std::string, std::vector<std::filesystem::path>> below;       // a folder
        std::map<std::string, std::string>                        states;      // of a file
    };
    KnownShaders shaders;
};

CompiledPipeline read_compiled(const Gpu& gpu, const std::string& shader, const vk::raii::Pipeline& pipeline);

Commands make_commands(Gpu& gpu);

/// Records commands, submits them and waits. Throws Failure if the device is lost or the wait exceeds five minutes.
void submit(Gpu& gpu, const std::function<void(const Commands&)>& record);

/// A full barrier between two passes: all earlier writes become visible to all later reads.
void barrier(const Commands& commands);

} // namespace ssrlab
