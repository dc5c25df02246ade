// A scene a million metres from the world's origin reflects as it does at the origin.
#include "core/files.h"
#include "gpu/device.h"

namespace ssrlab::test {
namespace {

std::string recipe_at(double x, double z)
{
    const auto at = [&](double dx, double y, double dz) { return fmt::format("[{}, {}, {}]", x + dx, y, z + dz); };
    return fmt::format(R"(summary = "Three shapes on a mirror."
[[part]]
shape = "plane"
size_m = [8, 0, 8]
position = {}
material = {{ metallic = 1, roughness = 0 }}
[[part]]
shape = "box"
size_m = [1, 1.5, 0.3]
position = {}
[[part]]
shape = "cylinder"
size_m = [0.05, 2, 0.05]
position = {}
[[view]]
name = "default"
position = {}
target = {}
)",
                       at(0, 0, 0), at(0.7, 0, -1), at(-0.8, 0, -0.5), at(0.3, 1.3, 4), at(0, 0.4, 0));
}

TEST(FarFromTheOrigin, AMillionMetresMoveNoHitByMoreThanAPixel)
{
    std::string pattern = (std::filesystem::temp_directory_path() / "far.XXXXXX").string();
    const auto  folder  = std::filesystem::path(::mkdtemp(pattern.data()));
    const auto  result  = [&](const std::string& name, double x, double z) {
        write_file_atomically(folder / (name + ".toml"), recipe_at(x, z));
        const Picture picture = make_picture((folder / (name + ".toml")).string(), "default", {320, 180});
        return trace(picture, technique("dda"), values_of(technique("dda")),
                       boxes({.thickness_m = 0.1, .max_distance_m = 100}));
    };
    const TraceImage near = result("near", 0, 0), far = result("far", 1e6, -1e6);
    std::filesystem::remove_all(folder);

    size_t hits = 0, other_status = 0, moved = 0;
    for (size_t i = 0; i < near.status.size(); ++i) {
        other_status += near.status[i] != far.status[i];
        if (near.status[i] != TraceStatus::hit || far.status[i] != TraceStatus::hit) continue;
        ++hits;
        const glm::ivec2 d = glm::abs(near.hit_pixel[i] - far.hit_pixel[i]);
        moved += d.x > 1 || d.y > 1;
    }
    fmt::print("{} hits, {} rays end otherwise, {} hits moved by more than a pixel\n", hits, other_status, moved);
    EXPECT_GT(hits, 1000U);
    // Silhouettes may be sampled to either side of an edge.
    EXPECT_LE(other_status, hits / 1000);
    EXPECT_LE(moved, hits / 1000);
}

} // namespace
} // namespace ssrlab::test
