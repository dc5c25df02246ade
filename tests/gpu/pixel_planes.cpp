// What the G-buffer says of the plane and the solid of a pixel, against closed forms.
#include "core/pixel_index.h"
#include "core/plane_gradient.h"
#include "gpu/device.h"
#include "unit/truth_scenes.h"

namespace ssrlab::test {
namespace {

Camera camera_at_the_origin(Projection projection)
{
    Camera camera;
    camera.position_ws = {0, 0, 0};
    camera.target_ws   = {0, 0, -1};
    camera.projection  = projection;
    camera.height_m    = 6;
    camera.far_m       = 40;
    return camera;
}

class PixelPlanes : public testing::TestWithParam<Projection> {};

/// A tilted wall: every gradient is that of its normal, within what 8 significant bits hold.
TEST_P(PixelPlanes, OfTheRasteriserAreThoseOfTheNormals)
{
    Scene scene;
    add_quad(scene, add_material(scene, glm::vec3(1), 1), {-60, -40, -20}, {120, 10, 8}, {5, 80, 25});
    const Picture picture = make_picture(scene, camera_at_the_origin(GetParam()), {161, 91});
    GBufferImage  by_normal{picture.image};
    by_normal.gradient.clear();
    complete_gradients(by_normal);
    size_t surfaces = 0;
    for (size_t i = 0; i < picture.image.depth.size(); ++i) {
        if (!(picture.image.depth[i] > 0)) continue;
        ++surfaces;
        for (const int axis : {0, 1}) {
            const float expected = by_normal.gradient[i][axis];
            ASSERT_NEAR(picture.image.gradient[i][axis], expected, std::abs(expected) / 64 + 1e-6F)
                << pixel_at(i, picture.view.size_px).x << ", " << pixel_at(i, picture.view.size_px).y;
        }
    }
    EXPECT_GT(surfaces, 1000U);
}

INSTANTIATE_TEST_SUITE_P(Views, PixelPlanes, testing::Values(Projection::perspective, Projection::orthographic),
                         [](const auto& view) {
                             return view.param == Projection::perspective ? "perspective" : "orthographic";
                         });

/// Three strips of wall at Z = 4: behind the left one its own back at Z = 6, behind the middle one another front at Z = 6, behind the right one nothing.
TEST(SolidBacks, LieWhereTheNextSurfaceShowsItsBack)
{
    Scene          scene;
    const uint32_t material = add_material(scene, glm::vec3(1), 1);
    add_quad(scene, material, {-9, -9, -4}, {18, 0, 0}, {0, 18, 0});
    add_quad(scene, material, {-2, -9, -6}, {-9, 0, 0}, {0, 18, 0}); // its front looks away
    add_quad(scene, material, {-2, -9, -6}, {4, 0, 0}, {0, 18, 0});
    add_quad(scene, material, {-12, -9, -9}, {24, 0, 0},
             {0, 18, 0}); // behind both, and behind nothing at the right: thin there, too
    const Picture picture = make_picture(scene, camera_at_the_origin(Projection::perspective), {96, 48});
    const auto    at      = [&](int x) { return picture.image.solid_back[pixel_index({x, 24}, picture.view.size_px)]; };
    EXPECT_NEAR(at(4), distance_to_depth(picture.view, 6), 1e-6);
    EXPECT_EQ(at(48), 0);
    EXPECT_EQ(at(92), 0);
}

} // namespace
} // namespace ssrlab::test
