// Times of techniques come back from their file as they were kept; a damaged file is refused.
#include "harness/kept_times.h"

#include "core/environment_variable.h"
#include "core/error.h"
#include "core/files.h"
#include "temp_folder.h"
#include "test.h"

namespace ssrlab {
namespace {

const std::vector<KeptTimes> kept = {{"64x36, box", "state", 7, {{"dda", 2.5}, {"hiz", 1}}, {}},
                                     {"8x8, plane", "other", 1, {{"dda", 0}}, {{"mine", "line 1\n\"quoted\""}}}};

bool same(const KeptTimes& a, const KeptTimes& b)
{
    return a.frame == b.frame && a.state == b.state && a.rays == b.rays && a.ms == b.ms && a.left_out == b.left_out;
}

TEST(KeptTimes, ComeBackAsTheyWereKept)
{
    const TempFolder folder;
    const auto       file = folder / "not/yet/there.json";
    EXPECT_TRUE(read_kept_times(file).empty());
    write_kept_times(file, "a device", kept);
    const std::vector<KeptTimes> read = read_kept_times(file);
    ASSERT_EQ(read.size(), kept.size());
    for (size_t i = 0; i < kept.size(); ++i) EXPECT_TRUE(same(read[i], kept[i])) << i;
}

TEST(KeptTimes, EachDeviceHasAFileOfItsOwn)
{
    const TempFolder          folder;
    const EnvironmentVariable cache("XDG_CACHE_HOME", folder.path().string());
    const auto                file = kept_times_file("A/B (1, 256 bits)");
    EXPECT_EQ(file, folder / "ssrlab/exact_A_B__1__256_bits_.json");
    EXPECT_NE(file, kept_times_file("A/B (2, 256 bits)"));
}

TEST(KeptTimes, ADamagedFileIsRefusedAtEveryCut)
{
    const TempFolder folder;
    const auto       file = folder / "times.json";
    write_kept_times(file, "a device", kept);
    const std::string whole = read_file(file);
    for (size_t length = 0; length + 2 < whole.size(); length += 7) {
        write_file_atomically(file, whole.substr(0, length));
        EXPECT_THROW(read_kept_times(file), SpecError) << whole.substr(0, length);
    }
    for (const char* ms : {"{}", "{\"dda\": -1}", "{\"dda\": \"fast\"}", "[1]", "{\"dda\": 1e999}"}) {
        write_file_atomically(file, std::string(R"({"measurements": [{"frame": "a", "state": "b", "rays": 1, "ms": )") +
                                        ms + R"(, "left_out": {}}]})");
        EXPECT_THROW(read_kept_times(file), SpecError) << ms;
    }
}

} // namespace
} // namespace ssrlab
