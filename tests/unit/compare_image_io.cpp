// Images on disk: exact, atomic, reproducible, and clear when it fails.
#include "compare/image_io.h"
#include "core/error.h"
#include "test.h"

#include <sys/resource.h>
#include <unistd.h>

#include <csignal>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

class ImageIo : public testing::Test {
protected:
    ImageIo() : folder_(fs::temp_directory_path() / ("ssrlab_image_io_" + std::to_string(getpid())))
    {
        fs::create_directories(folder_);
    }
    ~ImageIo() override { fs::remove_all(folder_); }

    std::vector<std::string> files() const
    {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder_)) names.push_back(entry.path().filename());
        return names;
    }

    fs::path folder_;
};

Image sample_image()
{
    Image image;
    image.size_px  = {3, 2};
    image.channels = {"zeta", "R", "depth", "A"};
    for (int i = 0; i < 24; ++i) image.values.push_back(0.1F * float(i) - 0.7F);
    image.metadata["ssrlab:view"] = "default";
    return image;
}

float value_of(const Image& image, const std::string& channel, size_t pixel)
{
    const auto place = std::find(image.channels.begin(), image.channels.end(), channel) - image.channels.begin();
    return image.values.at(pixel * image.channels.size() + size_t(place));
}

std::string bytes_of(const fs::path& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

TEST_F(ImageIo, ExrKeepsEveryBitByName)
{
    const Image image = sample_image();
    write_image(folder_ / "a.exr", image);
    const Image read = read_image(folder_ / "a.exr");
    EXPECT_EQ(read.size_px, image.size_px);
    ASSERT_EQ(read.channels.size(), 4U);
    for (const std::string& channel : image.channels) {
        for (size_t i = 0; i < 6; ++i) EXPECT_EQ(value_of(read, channel, i), value_of(image, channel, i)) << channel;
    }
    EXPECT_EQ(read.metadata.at("ssrlab:view"), "default");
    EXPECT_THAT(files(), testing::ElementsAre("a.exr"));
}

TEST_F(ImageIo, SamePictureSameFile)
{
    write_image(folder_ / "a.exr", sample_image());
    write_image(folder_ / "b.exr", sample_image());
    EXPECT_EQ(bytes_of(folder_ / "a.exr"), bytes_of(folder_ / "b.exr"));
    write_image(folder_ / "a.png", sample_image());
    write_image(folder_ / "b.png", sample_image());
    EXPECT_EQ(bytes_of(folder_ / "a.png"), bytes_of(folder_ / "b.png"));
}

TEST_F(ImageIo, PngIsSrgbEncoded)
{
    Image image;
    image.size_px  = {4, 1};
    image.channels = {"R", "G", "B"};
    image.values   = {0, 0.2140411F, 1, -3, 9, NAN, 0.5F, 0.5F, 0.5F, 1, 1, 1};
    write_image(folder_ / "a.png", image);
    const Image read = read_image(folder_ / "a.png");
    EXPECT_THAT(std::vector(read.values.begin(), read.values.begin() + 6),
                testing::ElementsAre(0, testing::FloatNear(0.5F, 0.003F), 1, 0, 1, 0));
}

TEST_F(ImageIo, FailuresNameThePath)
{
    EXPECT_THROW(write_image(folder_ / "missing" / "a.exr", sample_image()), Failure);
    EXPECT_THROW(write_image(folder_ / "a.jpg", sample_image()), SpecError);
    EXPECT_THROW(read_image(folder_ / "none.exr"), Failure);
    Image wrong = sample_image();
    wrong.values.pop_back();
    EXPECT_THROW(write_image(folder_ / "a.exr", wrong), Failure);
    std::ofstream(folder_ / "rubbish.exr") << "not an image";
    try {
        read_image(folder_ / "rubbish.exr");
        FAIL();
    } catch (const Failure& failure) {
        EXPECT_THAT(failure.what(), testing::HasSubstr("rubbish.exr"));
    }
}

// A full disk, as a limit on the size of files: an error, no file under the final name, and the old one intact.
TEST_F(ImageIo, FullDiskLeavesNoPartialFile)
{
    Image large;
    large.size_px  = {512, 512};
    large.channels = {"R", "G", "B"};
    for (int i = 0; i < 512 * 512 * 3; ++i) large.values.push_back(float(i % 10007 * 7919 % 10007));
    write_image(folder_ / "old.exr", sample_image());
    const std::string old = bytes_of(folder_ / "old.exr");
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit small{100000, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    EXPECT_THROW(write_image(folder_ / "new.exr", large), Failure);
    EXPECT_THROW(write_image(folder_ / "old.exr", large), Failure);
    setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_THAT(files(), testing::ElementsAre("old.exr"));
    EXPECT_EQ(bytes_of(folder_ / "old.exr"), old);
}

TEST_F(ImageIo, TruncatedFileIsAFailure)
{
    write_image(folder_ / "a.exr", sample_image());
    fs::resize_file(folder_ / "a.exr", fs::file_size(folder_ / "a.exr") - 20);
    EXPECT_THROW(read_image(folder_ / "a.exr"), Failure);
}

} // namespace
} // namespace ssrlab
