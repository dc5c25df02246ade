// Which device is opened when several are there, and which of its kinds of memory is taken.
#include "core/error.h"
#include "gpu/gpu.h"
#include "gpu/resources.h"
#include "test.h"

namespace ssrlab::test {
namespace {

GpuInfo device(int index, const std::string& type, const std::string& name)
{
    GpuInfo info;
    info.index = index;
    info.type  = type;
    info.name  = name;
    return info;
}

TEST(DeviceChoice, TakesTheFastestKind)
{
    std::vector<GpuInfo> devices = {device(0, "Cpu", "llvmpipe"), device(1, "VirtualGpu", "virtio"),
                                    device(2, "IntegratedGpu", "Iris"), device(3, "DiscreteGpu", "Navi")};
    for (const int best : {3, 2, 1, 0}) {
        EXPECT_EQ(choose_device(devices, ""), best);
        devices.pop_back();
    }
    EXPECT_THROW(choose_device(devices, ""), Failure);
}

TEST(DeviceChoice, FollowsANumberOrAPartOfTheName)
{
    const std::vector<GpuInfo> devices = {device(0, "DiscreteGpu", "Navi"), device(1, "Cpu", "llvmpipe (LLVM)")};
    EXPECT_EQ(choose_device(devices, "1"), 1);
    EXPECT_EQ(choose_device(devices, "LLVMPIPE"), 1);
    EXPECT_THROW(choose_device(devices, "Arc"), SpecError);
}

TEST(MemoryChoice, TakesWhatTheCpuCachesWhereThatIsBetter)
{
    using Property                          = vk::MemoryPropertyFlagBits;
    const vk::MemoryPropertyFlags      host = Property::eHostVisible | Property::eHostCoherent;
    vk::PhysicalDeviceMemoryProperties properties;
    for (const vk::MemoryPropertyFlags flags : {vk::MemoryPropertyFlags(Property::eDeviceLocal), host,
                                                host | Property::eHostCached, host | Property::eDeviceLocal})
        properties.memoryTypes[properties.memoryTypeCount++].propertyFlags = flags;
    EXPECT_EQ(choose_memory_type(properties, 0b1111, host, {}), 1U);
    EXPECT_EQ(choose_memory_type(properties, 0b1111, host, Property::eHostCached), 2U);
    EXPECT_EQ(choose_memory_type(properties, 0b1011, host, Property::eHostCached), 1U) << "the cached one not allowed";
    EXPECT_EQ(choose_memory_type(properties, 0b1000, host, Property::eHostCached), 3U);
    EXPECT_THROW(choose_memory_type(properties, 0b0001, host, Property::eHostCached), Failure);
}

} // namespace
} // namespace ssrlab::test
