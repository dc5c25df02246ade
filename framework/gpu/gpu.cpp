#include "gpu/vulkan.h"

#include "core/error.h"
#include "gpu/disk_cache.h"
#include "gpu/driver_threads.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>

namespace ssrlab {
namespace {

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL keep_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                            const VkDebugUtilsMessengerCallbackDataEXT* data, void* user)
{
    auto*            impl = static_cast<GpuImpl*>(user);
    std::scoped_lock lock(impl->messages_mutex);
    impl->messages.emplace_back(data->pMessage);
    return VK_FALSE;
}

bool has_layer(const vk::raii::Context& context)
{
    const auto layers = context.enumerateInstanceLayerProperties();
    return std::ranges::any_of(
        layers, [](const vk::LayerProperties& layer) { return std::strcmp(layer.layerName, validation_layer) == 0; });
}

vk::raii::Instance make_instance(const vk::raii::Context& context, bool validation)
{
    if (validation && !has_layer(context))
        throw_failure("{} is not installed (Debian: vulkan-validationlayers)", validation_layer);
    const vk::ApplicationInfo application{.pApplicationName = "ssrlab", .apiVersion = VK_API_VERSION_1_3};
    const char* const         extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    // Synchronization validation on top of core validation: hazards between passes are errors too.
    const vk::ValidationFeatureEnableEXT enable = vk::ValidationFeatureEnableEXT::eSynchronizationValidation;
    const vk::ValidationFeaturesEXT features{.enabledValidationFeatureCount = 1, .pEnabledValidationFeatures = &enable};
    vk::InstanceCreateInfo          info{.pApplicationInfo = &application};
    if (validation) {
        info.pNext                   = &features;
        info.enabledLayerCount       = 1;
        info.ppEnabledLayerNames     = &validation_layer;
        info.enabledExtensionCount   = 1;
        info.ppEnabledExtensionNames = &extension;
    }
    try {
        return {context, info};
    } catch (const vk::SystemError& error) {
        const char* icd = std::getenv("VK_ICD_FILENAMES");
        throw_failure("no Vulkan driver could be loaded ({}; VK_ICD_FILENAMES={}). Debian: install mesa-vulkan-drivers",
                      error.what(), icd != nullptr ? icd : "unset");
    }
}

/// A virtual machine may hide the name, "AMD EPYC": family and model tell generations apart.
std::string processor_name()
{
    std::map<std::string, std::string> of_first_core;
    std::ifstream                      cores("/proc/cpuinfo");
    for (std::string line; std::getline(cores, line) && !line.empty();) {
        const size_t colon = line.find(':'), end = line.find_last_not_of(" \t", colon - 1);
        if (colon != std::string::npos && colon + 2 <= line.size())
            of_first_core[line.substr(0, end + 1)] = line.substr(colon + 2);
    }
    std::string text;
    for (const auto& [field, before] :
         {std::pair("model name", ""), {"cpu family", ", family "}, {"model", ", model "}})
        if (of_first_core.contains(field)) text += before + of_first_core[field];
    return text.empty() ? "not known" : text;
}

/// Rays of an 8K picture take 66 million texels. The standard promises 65,536 (Vulkan 1.3, table "Required Limits").
constexpr uint32_t enough_texels = 1U << 27;

/// Invocations of a subgroup that may work on one ray group: a power of two. 1 where parallel passes cannot run: they vote, ballot and shuffle, and a
/// subgroup of theirs lies in one tile of 64 pixels.
int lanes_of(const vk::PhysicalDeviceSubgroupProperties& subgroups)
{
    constexpr uint32_t most = 8;
    using Feature           = vk::SubgroupFeatureFlagBits;
    const auto needed       = Feature::eVote | Feature::eBallot | Feature::eShuffle;
    const bool usable       = (subgroups.supportedStages & vk::ShaderStageFlagBits::eCompute) &&
                        (subgroups.supportedOperations & needed) == needed && subgroups.subgroupSize <= 64;
    return usable ? static_cast<int>(std::min(most, std::bit_floor(subgroups.subgroupSize))) : 1;
}

GpuInfo describe(const vk::raii::PhysicalDevice& device, int index)
{
    const auto  chain = device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties,
                                             vk::PhysicalDeviceSubgroupProperties>();
    const auto& core  = chain.get<vk::PhysicalDeviceProperties2>().properties;
    const auto& drive = chain.get<vk::PhysicalDeviceDriverProperties>();
    GpuInfo     info;
    info.index       = index;
    info.name        = core.deviceName.data();
    info.type        = vk::to_string(core.deviceType);
    info.driver      = fmt::format("{} {}", drive.driverName.data(), drive.driverInfo.data());
    info.api_version = fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(core.apiVersion),
                                   VK_API_VERSION_MINOR(core.apiVersion), VK_API_VERSION_PATCH(core.apiVersion));
    info.float64     = device.getFeatures().shaderFloat64 != 0;
    info.max_drawn_px =
        std::min({core.limits.maxImageDimension2D, core.limits.maxFramebufferWidth, core.limits.maxFramebufferHeight});
    info.int64          = device.getFeatures().shaderInt64 != 0;
    const bool software = core.deviceType == vk::PhysicalDeviceType::eCpu;
    if (software) info.processor = processor_name();
    info.cheap_doubles = software && info.float64;
    info.plain_buffers = core.limits.maxTexelBufferElements < enough_texels;
    info.most_lanes    = lanes_of(chain.get<vk::PhysicalDeviceSubgroupProperties>());
    info.lanes         = software ? 1 : info.most_lanes;
    return info;
}

bool contains_ignoring_case(const std::string& text, const std::string& part)
{
    return std::search(text.begin(), text.end(), part.begin(), part.end(), [](char a, char b) {
               return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
           }) != text.end();
}

uint32_t find_queue_family(const vk::raii::PhysicalDevice& device)
{
    const auto families = device.getQueueFamilyProperties();
    for (uint32_t i = 0; i < families.size(); ++i) {
        const auto needed = vk::QueueFlagBits::eGraphics | vk::QueueFlagBits::eCompute;
        if ((families[i].queueFlags & needed) == needed && families[i].timestampValidBits > 0) return i;
    }
    throw_failure("the device has no queue with graphics, compute and timestamps");
}

constexpr const char* executable_properties = VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME;

void require_executable_properties(const vk::raii::PhysicalDevice& device, const GpuInfo& info)
{
    const auto extensions = device.enumerateDeviceExtensionProperties();
    if (std::ranges::none_of(extensions, [](const vk::ExtensionProperties& extension) {
            return std::strcmp(extension.extensionName, executable_properties) == 0;
        }))
        throw_failure("the device '{}' does not say what it compiles: it has no {}", info.name, executable_properties);
}

/// Plain buffers come with robust buffer access: a ray of a pair that has ended still reads, for nothing and outside of the picture, and without it
/// SwiftShader reads memory that is not mapped. Drivers check the bounds of texel buffers by themselves.
vk::raii::Device make_device(const vk::raii::PhysicalDevice& physical_device, uint32_t queue_family,
                             const GpuOptions& options, bool plain_buffers)
{
    const vk::PhysicalDeviceFeatures available = physical_device.getFeatures();
    const float                      priority  = 1.0F;
    const vk::DeviceQueueCreateInfo  queue{
         .queueFamilyIndex = queue_family, .queueCount = 1, .pQueuePriorities = &priority};
    vk::PhysicalDeviceVulkan13Features features13{
        .synchronization2 = true, .dynamicRendering = true, .maintenance4 = true};
    vk::PhysicalDeviceVulkan12Features features12{.pNext = &features13, .scalarBlockLayout = true};
    vk::PhysicalDeviceFeatures2        features{
               .pNext    = &features12,
               .features = {.robustBufferAccess = options.robust_buffer_access || plain_buffers,
                            .samplerAnisotropy  = available.samplerAnisotropy,
                            .shaderFloat64      = available.shaderFloat64,
                            .shaderInt64        = available.shaderInt64}};
    const vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR described{.pNext                  = &features,
                                                                              .pipelineExecutableInfo = true};
    vk::DeviceCreateInfo info{.pNext = &features, .queueCreateInfoCount = 1, .pQueueCreateInfos = &queue};
    if (options.compiles_only) {
        info.pNext                   = &described;
        info.enabledExtensionCount   = 1;
        info.ppEnabledExtensionNames = &executable_properties;
    }
    return {physical_device, info};
}

/// Pipelines of one device and driver version; of another one, the driver would refuse them.
void open_pipeline_cache(GpuImpl& impl)
{
    const auto properties = impl.physical_device.getProperties();
    impl.pipeline_cache_name =
        fmt::format("pipelines-{:x}-{:x}-{:x}-", properties.vendorID, properties.deviceID, properties.driverVersion);
    for (const uint8_t byte : properties.pipelineCacheUUID) impl.pipeline_cache_name += fmt::format("{:02x}", byte);
    const std::string kept    = read_cached(impl.pipeline_cache_name).value_or("");
    impl.pipeline_cache_bytes = kept.size();
    impl.pipeline_cache       = {impl.device,
                                 vk::PipelineCacheCreateInfo{.initialDataSize = kept.size(), .pInitialData = kept.data()}};
}

std::vector<GpuInfo> describe_all(const vk::raii::Instance& instance)
{
    std::vector<GpuInfo> infos;
    for (const auto& device : vk::raii::PhysicalDevices(instance))
        infos.push_back(describe(device, static_cast<int>(infos.size())));
    return infos;
}

} // namespace

GpuImpl::~GpuImpl()
{
    try {
        if (*pipeline_cache == vk::PipelineCache()) return;
        const std::vector<uint8_t> data = pipeline_cache.getData();
        if (data.size() > pipeline_cache_bytes)
            write_cached(pipeline_cache_name, {reinterpret_cast<const char*>(data.data()), data.size()});
    } catch (const std::exception&) { // compiled again next time
    }
}

std::vector<GpuInfo> list_gpus()
{
    const vk::raii::Context context;
    try {
        return describe_all(make_instance(context, false));
    } catch (const vk::SystemError& error) {
        throw_failure("Vulkan devices cannot be listed: {}", error.what());
    }
}

Gpu open_gpu(const GpuOptions& options)
{
    Gpu                 gpu{std::make_shared<GpuImpl>(), {}};
    GpuImpl&            impl           = *gpu.impl;
    const std::set<int> threads_before = thread_ids();
    try {
        impl.instance = make_instance(impl.context, options.validation);
        if (options.validation) {
            using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
            using Type     = vk::DebugUtilsMessageTypeFlagBitsEXT;
            impl.messenger = {
                impl.instance,
                vk::DebugUtilsMessengerCreateInfoEXT{
                    .messageSeverity = Severity::eWarning | Severity::eError,
                    .messageType =
                        Type::eValidation, // not performance: every image stays in GENERAL, one layout for all uses
                    .pfnUserCallback = keep_message,
                    .pUserData       = &impl}};
        }
        const auto infos = describe_all(impl.instance);
        gpu.info         = infos[static_cast<size_t>(choose_device(infos, options.device))];
        if (options.storage != TexelStorage::by_device)
            gpu.info.plain_buffers = options.storage == TexelStorage::plain_buffers;
        if (options.passes == PassStyle::parallel && gpu.info.most_lanes == 1)
            throw_spec_error(
                "the device '{}' cannot run passes in parallel: its subgroups lack votes, ballots or shuffles",
                gpu.info.name);
        if (options.passes != PassStyle::by_device)
            gpu.info.lanes = options.passes == PassStyle::parallel ? gpu.info.most_lanes : 1;
        impl.physical_device = std::move(vk::raii::PhysicalDevices(impl.instance)[static_cast<size_t>(gpu.info.index)]);
        impl.queue_family    = find_queue_family(impl.physical_device);
        impl.limits          = impl.physical_device.getProperties().limits;
        impl.timestamp_period_ns = static_cast<double>(impl.limits.timestampPeriod);
        const uint32_t bits    = impl.physical_device.getQueueFamilyProperties()[impl.queue_family].timestampValidBits;
        impl.timestamp_mask    = bits >= 64 ? ~0ULL : (1ULL << bits) - 1;
        gpu.info.compiles_only = options.compiles_only;
        if (options.compiles_only) require_executable_properties(impl.physical_device, gpu.info);
        impl.device = make_device(impl.physical_device, impl.queue_family, options, gpu.info.plain_buffers);
        impl.queue  = impl.device.getQueue(impl.queue_family, 0);
        if (options.compiles_only) return gpu;
        if (contains_ignoring_case(gpu.info.name, "llvmpipe")) spread_threads_since(threads_before);
        impl.command_pool = {impl.device, vk::CommandPoolCreateInfo{.queueFamilyIndex = impl.queue_family}};
        open_pipeline_cache(impl); // of pipelines that it knows, a driver may not say how they were compiled
    } catch (const vk::SystemError& error) {
        throw_failure("the Vulkan device cannot be opened: {}", error.what());
    }
    return gpu;
}

int choose_device(std::span<const GpuInfo> infos, const std::string& wanted)
{
    if (infos.empty()) throw_failure("no Vulkan device found. Debian: install mesa-vulkan-drivers");
    if (wanted.empty()) {
        for (const char* type : {"DiscreteGpu", "IntegratedGpu", "VirtualGpu", "Cpu"})
            for (const GpuInfo& info : infos)
                if (info.type == type) return info.index;
        return infos.front().index;
    }
    std::string names;
    for (const GpuInfo& info : infos) {
        if (wanted == std::to_string(info.index) || contains_ignoring_case(info.name, wanted)) return info.index;
        names += fmt::format("\n  {} {}", info.index, info.name);
    }
    throw_spec_error("device '{}' not found; devices are:{}", wanted, names);
}

const char* storage_text(const GpuInfo& device) { return device.plain_buffers ? "plain buffers" : "texel buffers"; }

const char* passes_text(const GpuInfo& device) { return device.lanes > 1 ? "parallel" : "serial"; }

size_t pipelines_made(const Gpu& gpu) { return gpu.impl->pipelines_made; }

void finish_pipelines(const Gpu& gpu)
{
    for (const auto& [key, known] : gpu.impl->known_pipelines) known.pipeline->pipeline.wait();
}

std::vector<std::string> validation_messages(const Gpu& gpu)
{
    std::scoped_lock lock(gpu.impl->messages_mutex);
    return gpu.impl->messages;
}

Commands make_commands(Gpu& gpu)
{
    vk::raii::CommandBuffers buffers(gpu.impl->device,
                                     {.commandPool = *gpu.impl->command_pool, .commandBufferCount = 1});
    return Commands(std::move(buffers[0]));
}

void submit(Gpu& gpu, const std::function<void(const Commands&)>& record)
{
    if (gpu.info.compiles_only) return;
    constexpr uint64_t five_minutes_ns = 300ULL * 1000 * 1000 * 1000;
    GpuImpl&           impl            = *gpu.impl;
    try {
        const Commands commands = make_commands(gpu);
        commands.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
        record(commands);
        commands.end();
        const vk::raii::Fence fence(impl.device, vk::FenceCreateInfo{});
        impl.queue.submit(vk::SubmitInfo{.commandBufferCount = 1, .pCommandBuffers = &*commands}, *fence);
        if (impl.device.waitForFences(*fence, true, five_minutes_ns) != vk::Result::eSuccess)
            throw_failure("the device did not finish within five minutes");
    } catch (const vk::SystemError& error) {
        throw_failure("the device failed: {}", error.what());
    }
}

void barrier(const Commands& commands)
{
    if (!static_cast<bool>(*commands)) return; // they are only noted
    const vk::MemoryBarrier2 everything{.srcStageMask  = vk::PipelineStageFlagBits2::eAllCommands,
                                        .srcAccessMask = vk::AccessFlagBits2::eMemoryWrite,
                                        .dstStageMask  = vk::PipelineStageFlagBits2::eAllCommands,
                                        .dstAccessMask =
                                            vk::AccessFlagBits2::eMemoryRead | vk::AccessFlagBits2::eMemoryWrite};
    commands.pipelineBarrier2(vk::DependencyInfo{.memoryBarrierCount = 1, .pMemoryBarriers = &everything});
}

} // namespace ssrlab
