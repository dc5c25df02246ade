// Files that libraries do not survive, refused before they see them.
#include "errors.h"
#include "scene/environment.h"
#include "scene/exr_header.h"
#include "scene/image_file.h"
#include "scene_files.h"

namespace ssrlab {
namespace {

using ::testing::HasSubstr;

std::string number(uint32_t value)
{
    std::string bytes;
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFFU);
    return bytes;
}

std::string attribute(const std::string& name, const std::string& type, const std::string& data,
                      int64_t says_bytes = -1)
{
    const auto bytes = static_cast<uint32_t>(says_bytes < 0 ? static_cast<int64_t>(data.size()) : says_bytes);
    return name + '\0' + type + '\0' + number(bytes) + data;
}

std::string window(uint32_t right, uint32_t bottom)
{
    return attribute("dataWindow", "box2i", number(0) + number(0) + number(right) + number(bottom));
}

class ExrHeader : public ::testing::Test {
protected:
    void check(const std::string& attributes, uint32_t version = 2)
    {
        check_exr_header(write(attributes, version), "a.exr");
    }
    std::string refused(const std::string& attributes, uint32_t version = 2)
    {
        return message_of<Failure>([&] { check(attributes, version); });
    }

private:
    std::string write(const std::string& attributes, uint32_t version)
    {
        return folder_.write("a.exr", number(20000630) + number(version) + attributes);
    }

    TempFolder folder_;
};

TEST_F(ExrHeader, SizesThatFitArePassed)
{
    const std::string end(1, '\0');
    EXPECT_NO_THROW(check(window(16383, 16383) + attribute("a", "string", "text") +
                          attribute("n", "stringvector", number(2) + "ab" + number(0)) + end));
    EXPECT_NO_THROW(check(attribute("t", "tiledesc", number(64) + number(32) + "m") + end));
    constexpr uint32_t several_parts = 0x1002;
    EXPECT_NO_THROW(check(window(3, 1) + end + window(3, 1) + end + end, several_parts));
}

TEST_F(ExrHeader, SizesThatLieAreRefused)
{
    const std::string end(1, '\0');
    EXPECT_THAT(refused(attribute("a", "string", "text", 0x7FFFFFF0) + end),
                HasSubstr("a.exr: 'a' says that it has 2147483632 bytes, but 5 are left"));
    EXPECT_THAT(refused(attribute("a", "string", "text", 0xFFFFFFFF) + end),
                HasSubstr("'a' says that it has -1 bytes"));
    EXPECT_THAT(message_of<SpecError>([&] { check(window(16384, 0) + end); }),
                HasSubstr("a.exr: 16385x1 pixels, at most 16384 a side can be used"));
    EXPECT_THAT(refused(window(0, 0x80000000U) + end), HasSubstr("'dataWindow' has -2147483647 pixels a side"));
    EXPECT_THAT(refused(attribute("t", "tiledesc", number(64) + number(1U << 30U) + "m") + end),
                HasSubstr("'t' has 1073741824 pixels a side"));
    EXPECT_THAT(refused(attribute("p", "preview", number(1U << 20U) + number(1)) + end),
                HasSubstr("'p' has 1048576 pixels a side"));
    EXPECT_THAT(refused(attribute("n", "stringvector", number(9) + "ab") + end),
                HasSubstr("'n' has a text of 9 bytes"));
    EXPECT_THAT(refused(window(3, 1)), HasSubstr("cut off within its EXR header"));
    EXPECT_THAT(refused(window(3, 1) + end, 0x1002), HasSubstr("cut off within its EXR header"));
    EXPECT_THAT(refused(std::string(300, 'x')), HasSubstr("a name of its EXR header has no end"));
}

TEST(HostileFiles, APngThatIsCutOffIsRefused)
{
    const std::string signature = "\x89PNG\r\n\x1A\n", header = std::string("\0\0\0\x0DIHDR", 8) + std::string(17, 'x');
    const auto        refused = [](const std::string& bytes) {
        return message_of<Failure>([&] {
            decode_image({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()}, "a.png");
        });
    };
    EXPECT_THAT(refused(signature + header), HasSubstr("a.png: cut off: a PNG of 33 bytes"));
    EXPECT_THAT(refused(signature + header + std::string("\0\0\0\x05IDAT1234", 12)), HasSubstr("cut off"));
    EXPECT_THAT(refused(signature + header + std::string("\xFF\xFF\xFF\xFFIDAT1234", 12)), HasSubstr("cut off"));
    EXPECT_THAT(refused(signature), HasSubstr("cut off"));
    EXPECT_THAT(refused(signature + header + std::string("\0\0\0\0IEND\xAE\x42\x60\x82", 12)),
                HasSubstr("cannot be decoded"));
}

TEST(HostileFiles, AnEnvironmentIsReadAsWhatItsNameSays)
{
    TempFolder               folder;
    std::vector<std::string> warnings;
    const std::string        bmp     = "BM" + std::string(52, '\0');
    const auto               refused = [&](const std::string& name) {
        return message_of<Failure>([&] { load_environment(folder.write(name, bmp), 1, warnings); });
    };
    EXPECT_THAT(refused("sky.hdr"), HasSubstr("expected an .hdr or .exr picture"));
    EXPECT_THAT(refused("sky.EXR"), HasSubstr("cannot be read as EXR"));
}

} // namespace
} // namespace ssrlab
