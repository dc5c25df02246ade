// Only regular files are read: a pipe would be waited for, a device read without end.
#include "core/files.h"

#include "temp_folder.h"
#include "test.h"

#include "core/error.h"

#include <sys/stat.h>

namespace ssrlab {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Property;
using testing::Throws;

TEST(Files, AreReadToTheirEnd)
{
    const TempFolder  folder;
    const std::string bytes(300'000, 'x');
    const std::string file = folder.write("a.txt", bytes);
    EXPECT_EQ(read_file(file), bytes);
    EXPECT_EQ(read_regular_file(file, bytes.size()).size(), bytes.size());
    EXPECT_EQ(regular_file_bytes(file, bytes.size()), bytes.size());
    EXPECT_EQ(read_file(folder.write("empty", "")), "");
    EXPECT_FALSE(read_file("/proc/self/cmdline").empty()) << "it says that it has no bytes";
}

TEST(Files, OfOtherKindsAreRefused)
{
    const TempFolder folder;
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    std::filesystem::create_symlink("/dev/zero", folder / "zeros");
    for (const char* name : {"pipe", "zeros"}) {
        const auto refused =
            Throws<Failure>(Property(&Failure::what, AllOf(HasSubstr(name), HasSubstr("not a regular file"))));
        EXPECT_THAT([&] { read_file(folder / name); }, refused);
        EXPECT_THAT([&] { read_regular_file(folder / name, 100); }, refused);
    }
    EXPECT_THAT([&] { read_file(folder / "none"); },
                Throws<Failure>(Property(&Failure::what, AllOf(HasSubstr("none"), HasSubstr("No such file")))));
    EXPECT_THAT([&] { read_file(folder.path()); }, Throws<Failure>(Property(&Failure::what, HasSubstr("is a folder"))));
}

TEST(Files, LargerThanTheLimitAreRefused)
{
    const TempFolder  folder;
    const std::string file = folder.write("a.txt", "12345");
    const auto refused = Throws<Failure>(Property(&Failure::what, AllOf(HasSubstr("5 bytes"), HasSubstr("at most 4"))));
    EXPECT_THAT([&] { read_regular_file(file, 4); }, refused);
    EXPECT_THAT([&] { regular_file_bytes(file, 4); }, refused);
}

} // namespace
} // namespace ssrlab
