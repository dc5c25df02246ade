// Light that the CPU bakes into vertices, against closed forms.
#include "truth/bounced_light.h"
#include "scene_files.h"
#include "truth/truth_cache.h"
#include "truth_scenes.h"

#include <map>

namespace ssrlab::test {
namespace {

constexpr double pi = std::numbers::pi;

void add_room(Scene& scene, uint32_t material, double half_m)
{
    const double h = half_m, e = 2 * half_m;
    add_quad(scene, material, {-h, -h, h}, {e, 0, 0}, {0, 0, -e});
    add_quad(scene, material, {-h, h, -h}, {e, 0, 0}, {0, 0, e});
    add_quad(scene, material, {-h, -h, -h}, {e, 0, 0}, {0, e, 0});
    add_quad(scene, material, {h, -h, h}, {-e, 0, 0}, {0, e, 0});
    add_quad(scene, material, {-h, -h, h}, {0, 0, -e}, {0, e, 0});
    add_quad(scene, material, {h, -h, -h}, {0, 0, e}, {0, e, 0});
}

// The rendering equation in a closed room whose walls all emit e and send on the share a of what arrives: the n-th bounce adds e a^(n - 1).
TEST(BouncedLight, InAFurnaceIsAGeometricSeries)
{
    for (const int bounces : {1, 2, 5}) {
        Scene scene;
        scene.ambient                      = glm::vec3(0);
        const uint32_t material            = add_material(scene, {0.8F, 0.5F, 0}, 0.5F);
        scene.materials[material].emissive = {1, 2, 3};
        add_room(scene, material, 2);
        scene.bake          = Bake{.edge_m = 1, .paths = 1024, .bounces = bounces, .place = {}};
        const auto      sum = [&](double a) { return (1 - std::pow(a, bounces)) / (1 - a); };
        const glm::vec3 expected(sum(0.8), 2 * sum(0.5), 3);
        for (const glm::vec3& light : bounced_light(scene)) EXPECT_VEC_NEAR(light / expected, glm::vec3(1), 0.02F);
    }
}

// A lamp of intensity I in the middle of a sphere of radius r and albedo a: I / r^2 arrives everywhere, directly and then in equal shares. The
// sphere's normals look outwards; its material has two sides.
TEST(BouncedLight, OfALampInASphere)
{
    Scene scene;
    scene.ambient                          = glm::vec3(0);
    const uint32_t material                = add_material(scene, {0.6F, 0.6F, 0.6F}, 0);
    scene.materials[material].double_sided = true;
    add_sphere(scene, material, {0, 0, 0}, 2, 32);
    scene.lights.push_back(Light{LightType::point, {0, 0, 0}, {0, -1, 0}, {12, 12, 12}, 0, 0, 0, true});
    scene.bake            = Bake{.edge_m = 0.2, .paths = 256, .bounces = 3, .place = {}};
    const double expected = 12.0 / 4 / pi * (0.6 + 0.36 + 0.216);
    for (const glm::vec3& light : bounced_light(scene)) EXPECT_NEAR(double(light.x) / expected, 1, 0.02);
}

/// The share of a surface's view that a parallel rectangle h above takes; one of its corners stands above the point. J. Howell, "A Catalog of
/// Radiation Heat Transfer Configuration Factors", B-3.
double corner_factor(double a, double b, double h)
{
    const double x = a / h, y = b / h, u = std::sqrt(1 + x * x), v = std::sqrt(1 + y * y);
    return (x / u * std::atan(y / u) + y / v * std::atan(x / v)) / (2 * pi);
}

// From small and far to large and near: no sample may count too much. Then a black plate hides half of it.
TEST(BouncedLight, OfAPanelIsItsConfigurationFactor)
{
    for (const double half_m : {0.05, 0.5, 4.0, 40.0})
        for (const bool hidden : {false, true}) {
            SCOPED_TRACE(half_m);
            Scene          scene;
            const uint32_t black = add_material(scene, {0, 0, 0}, 0), panel = add_material(scene, {0, 0, 0}, 0);
            scene.materials[panel].emissive = {5, 5, 5};
            add_quad(scene, black, {-0.001, 0, 0.001}, {0.002, 0, 0}, {0, 0, -0.002});
            add_quad(scene, panel, {-half_m, 1, -half_m}, {2 * half_m, 0, 0}, {0, 0, 2 * half_m});
            if (hidden) add_quad(scene, black, {0, 0.5, -50}, {50, 0, 0}, {0, 0, 100});
            scene.bake = Bake{.edge_m = 0.01, .paths = 2048, .bounces = 1, .place = {}};
            EXPECT_NEAR(double(bounced_light(scene)[0].x) / 5 / corner_factor(half_m, half_m, 1), hidden ? 2 : 4, 0.05);
        }
}

TEST(BouncedLight, IsNamedByItsInput)
{
    Scene scene;
    add_floor(scene, add_material(scene, {1, 1, 1}, 0));
    scene.bake            = Bake{};
    const std::string key = bounced_light_key(scene);
    scene.bake->place     = "elsewhere:3";
    EXPECT_EQ(bounced_light_key(scene), key);
    scene.bake->paths *= 2;
    EXPECT_NE(bounced_light_key(scene), key);
    scene.bake = Bake{};
    scene.vertices[0].position_ws.x += 0.5F;
    EXPECT_NE(bounced_light_key(scene), key);
}

constexpr const char* two_part_recipe = "[[part]]\nshape = 'box'\nsize_m = [1, 2, 0.3]\nrotation_deg = [10, 20, 30]\n"
                                        "[[part]]\nshape = 'cylinder'\nposition = [3, 0, 0]\n";

std::string written(const TempFolder& folder, const std::string& recipe) { return folder.write("bake.toml", recipe); }

// Both shapes are closed: each edge, by its ends' positions, belongs to two triangles, which pass it in opposite directions.
TEST(BouncedLight, IsKeptByTrianglesWithoutCracks)
{
    const TempFolder folder;
    const Scene      coarse = load_scene(written(folder, two_part_recipe));
    const Scene      fine   = load_scene(written(folder, std::string("[bake]\nedge_m = 0.11\n") + two_part_recipe));
    ASSERT_TRUE(fine.bake.has_value());
    EXPECT_GT(fine.indices.size(), 20 * coarse.indices.size());
    using Place        = std::array<float, 3>;
    const auto area_m2 = [](const Scene& scene) {
        double area = 0;
        for (size_t i = 0; i < scene.indices.size(); i += 3)
            area += double(glm::length(
                        glm::cross(corner(scene, i + 1) - corner(scene, i), corner(scene, i + 2) - corner(scene, i)))) /
                    2;
        return area;
    };
    std::map<std::pair<Place, Place>, int> passed;
    for (size_t i = 0; i < fine.indices.size(); ++i) {
        const glm::vec3 a = corner(fine, i), b = corner(fine, i - i % 3 + (i + 1) % 3);
        EXPECT_LE(double(glm::length(b - a)), 0.11 + 1e-6);
        ++passed[{{a.x, a.y, a.z}, {b.x, b.y, b.z}}];
    }
    for (const auto& [edge, count] : passed) {
        EXPECT_EQ(count, 1);
        EXPECT_EQ((passed.count({edge.second, edge.first})), 1U);
    }
    EXPECT_NEAR(area_m2(fine) / area_m2(coarse), 1, 1e-5);
    for (const Vertex& vertex : fine.vertices) EXPECT_NEAR(glm::length(vertex.normal_ws), 1, 1e-5);
}

TEST(BouncedLight, IsNotBakedByBadRecipes)
{
    const TempFolder folder;
    const auto       mistake = [&](const std::string& bake) {
        return error_of<SpecError>(written(folder, bake + "[[part]]\nshape = 'plane'\nsize_m = [20, 0, 20]\n"));
    };
    EXPECT_THAT(mistake("\n[bake]\nedge_m = 0\n"), testing::HasSubstr("bake.toml:3: "));
    EXPECT_THAT(mistake("[bake]\npaths = 4\n"), testing::HasSubstr("'paths' must be"));
    EXPECT_THAT(mistake("[bake]\nbounces = 'all'\n"), testing::HasSubstr("'bounces' must be"));
    EXPECT_THAT(mistake("[bake]\nedges = 1\n"), testing::HasSubstr("edges"));
    EXPECT_THAT(mistake("[bake]\nedge_m = 0.005\n"),
                testing::HasSubstr("bake.toml:1: [bake]: edge_m = 0.005 makes more"));
}

} // namespace
} // namespace ssrlab::test
