// Which device is opened when several are there.
#include "core/error.h"
#include "gpu/gpu.h"

#include <gtest/gtest.h>

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

} // namespace
} // namespace ssrlab::test
