// One device, one queue. Opened once per program.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace ssrlab {

/// How shaders read rays, hits, depth and structures: as texels or as plain storage buffers, with the same bytes.
enum class TexelStorage { by_device, texel_buffers, plain_buffers };

/// How passes before the trace share work: one invocation per tile or ray group (CPU devices), or many (GPUs).
enum class PassStyle { by_device, serial, parallel };

struct GpuOptions {
    std::string device; // index, or part of the name; empty: a discrete GPU if present, else the first device
    bool        validation = false; // load the Khronos validation layer; every message is kept in validation_messages()
    bool        robust_buffer_access = false;
    TexelStorage storage             = TexelStorage::by_device;
    PassStyle    passes              = PassStyle::by_device;
    bool         compiles_only =
        false; // pipelines are made and described (gpu/compiled.h); there is no memory, and nothing runs
};

/// What environment.json says about the device.
struct GpuInfo {
    int         index = 0;
    std::string name, type, driver, api_version;
    std::string processor; // that a software device runs on, "NAME, family F, model M"; of other devices empty
    bool        float64       = false;
    bool        cheap_doubles = false; // they cost little more than floats
    uint32_t    max_drawn_px  = 0;     // largest side of a picture that it can draw
    bool        int64         = false; // 64-bit integers in shaders
    bool        compiles_only = false; // opened to compile only
    int         lanes = 1; // that share a ray group; above 1: passes before the trace take an invocation a pixel, too
    int         most_lanes = 1;     // that its subgroups allow
    bool plain_buffers     = false; // texel buffers hold fewer elements than a large picture needs, or it was asked for
};

struct GpuImpl;
/// Movable handle. Code that needs Vulkan itself includes gpu/vulkan.h.
struct Gpu {
    std::shared_ptr<GpuImpl> impl;
    GpuInfo                  info;
};

/// "texel buffers" or "plain buffers".
const char* storage_text(const GpuInfo& device);
/// "serial" or "parallel".
const char* passes_text(const GpuInfo& device);
/// Opens a device. Throws SpecError for an unknown one, Failure if there is no Vulkan driver.
Gpu                  open_gpu(const GpuOptions& options = {});
std::vector<GpuInfo> list_gpus();
/// Returns the index of the device with this number or part of a name. Empty: a discrete GPU, else an integrated one,
/// else a virtual one, else a CPU device. Throws SpecError listing the devices, Failure if there are none.
int choose_device(std::span<const GpuInfo> infos, const std::string& wanted);
/// Returns the messages of the validation layer so far; empty also if it is not loaded.
std::vector<std::string> validation_messages(const Gpu& gpu);
/// Returns the number of compute pipelines made so far. If it has not changed, all were known.
size_t pipelines_made(const Gpu& gpu);
/// Waits for all pipelines. Recording a pass waits only for its own, and threads that still compile disturb times.
void finish_pipelines(const Gpu& gpu);

} // namespace ssrlab
