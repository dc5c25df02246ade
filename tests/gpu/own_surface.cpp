// A surface model from outside the tree's own folders (tests/techniques/sloped_slab, which main.cpp names in $SSRLAB_TECHNIQUES).
#include "gpu/device.h"
#include "truth/pixel_surface.h"

namespace ssrlab::test {
namespace {

const TraceSettings sloped_slab{
    .thickness_m = 0.2, .max_distance_m = 20, .behind = Behind::stop, .surface = "sloped_slab"};

TEST(OwnSurface, IsFoundBesideTheShippedOnes)
{
    const Surface& own = find_surface(catalogue().surfaces, "sloped_slab");
    EXPECT_TRUE(own.needs_gradient);
    EXPECT_FALSE(own.needs_solid);
    EXPECT_FALSE(has_screen_truth(own.id));
    for (const Surface& surface : catalogue().surfaces) EXPECT_EQ(has_screen_truth(surface.id), surface.id != own.id);
}

TEST(OwnSurface, ExactTechniquesEqualThePixelWalk)
{
    for (const char* scene : {"interior", "thin_yard", "builtin:corridor"}) {
        Picture picture = make_picture(scene, "default", {241, 137});
        for (const int layers : {1, 2, 4}) {
            if (layers > most_layers()) continue;
            TraceSettings settings    = sloped_slab;
            settings.layers           = layers;
            const auto       found_by = [&](const Technique& t) { return trace(picture, t, values_of(t), settings); };
            const TraceImage walk     = found_by(technique("dda"));
            EXPECT_GT(std::ranges::count(walk.status, TraceStatus::hit), 500);
            std::string first;
            for (const Technique& t : catalogue().techniques) {
                if (!t.exact) continue;
                EXPECT_EQ(count_differences(found_by(t), walk, bit_equal_t, first), 0U)
                    << scene << " " << layers << " " << t.id << ": " << first;
            }
        }
    }
}

TEST(OwnSurface, IsNoneOfTheShippedOnes)
{
    const Picture picture = make_picture("interior", "default", {161, 91});
    const auto    found   = [&](const std::string& surface) {
        TraceSettings settings = sloped_slab;
        settings.surface       = surface;
        return trace(picture, technique("hiz"), values_of(technique("hiz")), settings);
    };
    std::string first;
    for (const char* shipped : {"box", "plane", "plane_solid"})
        EXPECT_GT(count_differences(found("sloped_slab"), found(shipped), any_t, first), 50U) << shipped;
}

} // namespace
} // namespace ssrlab::test
