// What is kept in the user's cache folder comes back whole or not at all.
#include "gpu/disk_cache.h"

#include "core/environment_variable.h"
#include "core/files.h"
#include "temp_folder.h"
#include "test.h"

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

class DiskCache : public testing::Test {
protected:
    TempFolder          folder_;
    EnvironmentVariable cache_{"XDG_CACHE_HOME", folder_.path().string()};
};

TEST_F(DiskCache, ReturnsWhatWasKept)
{
    const std::string bytes("a\0b\n", 4);
    EXPECT_EQ(read_cached("thing"), std::nullopt);
    write_cached("thing", bytes);
    EXPECT_EQ(read_cached("thing"), bytes);
    EXPECT_EQ(read_cached("other"), std::nullopt);
}

TEST_F(DiskCache, IgnoresDamagedFiles)
{
    write_cached("thing", "some bytes");
    const fs::path    file  = folder_ / "ssrlab/thing";
    const std::string whole = read_file(file);
    for (const std::string& damaged : {std::string(), whole.substr(0, 8), whole.substr(0, whole.size() - 1),
                                       whole + "x", std::string("garbage that is long enough for a hash")}) {
        write_file_atomically(file, damaged);
        EXPECT_EQ(read_cached("thing"), std::nullopt) << damaged;
    }
    write_file_atomically(file, whole);
    EXPECT_EQ(read_cached("thing"), "some bytes");
}

TEST_F(DiskCache, IgnoresFilesUnderAnothersName)
{
    write_cached("thing", "some bytes");
    write_cached("other", "more bytes");
    fs::copy_file(folder_ / "ssrlab/other", folder_ / "ssrlab/thing", fs::copy_options::overwrite_existing);
    EXPECT_EQ(read_cached("thing"), std::nullopt);
    EXPECT_EQ(read_cached("other"), "more bytes");
}

TEST_F(DiskCache, DoesWithoutAFolder)
{
    const EnvironmentVariable unwritable("XDG_CACHE_HOME", "/proc");
    write_cached("thing", "bytes");
    EXPECT_EQ(read_cached("thing"), std::nullopt);
    const EnvironmentVariable relative("XDG_CACHE_HOME", "relative");
    const EnvironmentVariable home("HOME", std::nullopt);
    write_cached("thing", "bytes");
    EXPECT_EQ(read_cached("thing"), std::nullopt);
}

} // namespace
} // namespace ssrlab
