// What is bound to a shader's names: texel buffers give what was stored, and mistakes are named.
#include "core/error.h"
#include "core/files.h"
#include "gpu/compute.h"
#include "gpu/device.h"

namespace ssrlab::test {
namespace {

constexpr size_t count = 4;

struct Buffers {
    Buffer floats       = make_texel_buffer(device(), count * 4, vk::Format::eR32Sfloat),
           words        = make_texel_buffer(device(), count * 4, vk::Format::eR32Uint),
           float_copies = make_buffer(device(), count * 4), word_copies = make_buffer(device(), count * 4);

    ComputePass pass(const Buffer& floats_or_not)
    {
        return make_compute_pass(
            device(), compile_shader(device(), {.file = data_root() / "tests/gpu/bindings.comp"}),
            {{"Floats", floats_or_not}, {"Words", words}, {"FloatCopies", float_copies}, {"WordCopies", word_copies}});
    }
};

TEST(Bindings, TexelBuffersGiveTheirValuesUnchanged)
{
    Buffers                     buffers;
    const std::vector<float>    floats{1.0F / 3, -2e-20F, 3e20F, 16777215};
    const std::vector<uint32_t> words{0, 1, 0x7F800001U, 0xFFFFFFFFU};
    upload(device(), buffers.floats, floats.data(), count * 4);
    upload(device(), buffers.words, words.data(), count * 4);
    const ComputePass pass = buffers.pass(buffers.floats);
    submit(device(), [&](const Commands& commands) {
        dispatch(commands, pass, {1, 1, 1});
        barrier(commands);
    });
    EXPECT_EQ(download_as<float>(device(), buffers.float_copies, count), floats);
    EXPECT_EQ(download_as<uint32_t>(device(), buffers.word_copies, count), words);
}

TEST(Bindings, APlainBufferIsNoTexelBuffer)
{
    if (device().info.plain_buffers) GTEST_SKIP() << "this device reads texels from plain buffers";
    Buffers buffers;
    EXPECT_THROW(buffers.pass(buffers.float_copies), std::logic_error);
}

TEST(Bindings, MoreTexelsThanTheDeviceAllowsAreRefused)
{
    const auto&    limits = device().impl->limits;
    const uint64_t most =
        device().info.plain_buffers ? limits.maxStorageBufferRange / 4 : limits.maxTexelBufferElements;
    EXPECT_THROW(make_texel_buffer(device(), (most + 1) * 4, vk::Format::eR32Sfloat), Failure);
}

} // namespace
} // namespace ssrlab::test
