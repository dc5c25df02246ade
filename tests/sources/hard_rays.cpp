// Rays that are hard for a source, with answers from geometry. All scenes are a room whose inside is convex: a ray
// meets the wall where it leaves the room, min over axes of (wall - origin) / direction, unless a part in it is nearer.
#include "compare/all_rays.h"
#include "core/error.h"
#include "gpu/device.h"
#include "scene/shapes.h"
#include "sources/answer_rays.h"

namespace ssrlab::test {
namespace {

using Point = glm::dvec3;

constexpr double    infinity = std::numeric_limits<double>::infinity();
constexpr Point     room_min{-5, -3, -8}, room_max{7, 4, 6};
const TraceSettings in_sight{.behind = Behind::stop, .surface = "plane_infinite"};

/// Walls that face inward, of material 0.
Model room()
{
    const Point x(room_max.x - room_min.x, 0, 0), y(0, room_max.y - room_min.y, 0), z(0, 0, room_max.z - room_min.z);
    Model       model;
    model.materials.push_back(make_material("wall", {0.5F, 0.5F, 0.5F}, 1, 0));
    for (const Mesh& wall : {make_quad(room_min, z, x), make_quad(room_max, -x, -z), make_quad(room_min, y, z),
                             make_quad(room_max, -z, -y), make_quad(room_min, x, y), make_quad(room_max, -y, -x)})
        model.meshes.push_back(wall);
    return model;
}

Point leaves_room(Point from, Point direction)
{
    double t = infinity;
    for (int axis : {0, 1, 2})
        if (direction[axis] != 0)
            t = std::min(t, ((direction[axis] > 0 ? room_max : room_min)[axis] - from[axis]) / direction[axis]);
    return from + t * direction;
}

/// 90 degrees wide: a pixel is 1 / 32 of the distance.
View looking(Point from, Point at)
{
    Camera camera;
    camera.position_ws = from;
    camera.target_ws   = at;
    camera.fov_y_deg   = 90;
    return camera_to_view(camera, {64, 64});
}

struct Asked {
    std::unique_ptr<Stage> stage;
    SourceContext          context;
};

Asked open_room(Model model, const View& view)
{
    auto stage = std::make_unique<Stage>(open_stage(device(), catalogue(), model_to_scene(std::move(model), "room")));
    show(*stage, view);
    const Technique& hiz     = technique("hiz");
    SourceContext    context = make_source_context(*stage, make_lab(*stage, hiz, values_of(hiz), in_sight));
    return {std::move(stage), std::move(context)};
}

enum Must { be_certain, be_a_point, be_no_other_point, be_open };

/// A ray from a point through another one; what it truly meets, where that is not the room's wall.
struct Row {
    const char*          what;
    Point                from, through;
    std::optional<Point> meets;
    Must                 must;
    double               clear_share = 0; // of the way to `through`: known to meet nothing
};

void expect_answers(Asked& asked, const std::string& source, std::span<const Row> rows)
{
    const auto           list = parse_sources(source, "test");
    const View&          view = asked.context.image.view;
    const Point          eye  = glm::inverse(view.world_to_view)[3];
    std::vector<OpenRay> rays;
    for (const Row& row : rows)
        rays.push_back({rays.size(), row.from, glm::normalize(row.through - row.from), glm::length(row.from - eye),
                        row.clear_share * glm::length(row.through - row.from), 1e9, 0});
    asked.context.parameters = list[0].values;
    const SourceTurn turn    = list[0].source->answer(asked.context, rays);
    for (size_t i = 0; i < rows.size(); ++i) {
        const Row&       row    = rows[i];
        const RayAnswer& answer = turn.answers[i];
        const Point      truth  = row.meets.value_or(leaves_room(row.from, row.through - row.from));
        // A tenth of a pixel: gradients are stored in eight bits.
        const double allowed_m = glm::length(truth - eye) / 320;
        SCOPED_TRACE(fmt::format("{}: {}; answer {} {} ({}, {}, {}), truth ({}, {}, {})", source, row.what,
                                 int(answer.kind), answer.certain, answer.point_ws.x, answer.point_ws.y,
                                 answer.point_ws.z, truth.x, truth.y, truth.z));
        EXPECT_NE(answer.kind, AnswerKind::nothing);
        if (row.must <= be_a_point) {
            EXPECT_EQ(answer.kind, AnswerKind::point);
        }
        if (row.must == be_certain) {
            EXPECT_TRUE(answer.certain);
        }
        if (row.must == be_open) {
            EXPECT_EQ(answer.kind, AnswerKind::open);
        }
        if (answer.kind == AnswerKind::point) {
            EXPECT_LE(glm::length(answer.point_ws - truth), allowed_m);
        }
    }
}

// The faces of a cube around the origin meet where |x|, |y| or |z| are equal.
TEST(HardRays, ThroughTheFacesOfACube)
{
    Asked     asked  = open_room(room(), looking({0, 0, 0}, {0, 0, -1}));
    const Row rows[] = {
        {"in one face", {-3.1, -1.1, -8}, {0, 2, -7.8}, {}, be_certain},
        {"through an edge, x = -z", {-3.1, -3, -7.1}, {3, 0.3, -3}, {}, be_certain},
        {"through an edge, y = z", {-1.1, 0.6, 6}, {0.5, 2, 2}, {}, be_certain},
        {"through a corner, x = y = -z", {-1.1, -3, -4.1}, {2, 2, -2}, {}, be_certain},
        {"through a corner, -x = -y = z", {0.1, 4, 1.1}, {-2, -2, 2}, {}, be_certain},
        {"from corner to corner along an edge, x = -z", {1, -3, -1}, {3, 0.5, -3}, {}, be_a_point},
        {"through four faces, in the plane x + y + z = 0", {-5, 1, 4}, {7, 0.5, -7.5}, {}, be_certain},
        {"from where four pixels meet", {-1, -3, -4}, {2, 2, -2}, {}, be_no_other_point},
        {"past the eye at 0.1 m", {-5, 0.1, 0.7}, {0, 0.1, 0.2}, {}, be_certain},
        {"radially away from the eye", {0.5, 0.25, -1}, {1, 0.5, -2}, {}, be_certain},
    };
    expect_answers(asked, "cube:size_px=64", rows);
}

// The first column of the face toward +x shows z from -3 to -3 + 3 / 32 at x = 3: there stands a strip. The ray enters
// that face where x = -z = 2.958, and meets the strip before it leaves the column.
TEST(HardRays, MeetWhatStandsInTheFirstPixelOfAFace)
{
    Model model = room();
    model.meshes.push_back(make_quad({3, -1, -2.995}, {0, 0, 0.09}, {0, 2, 0}));
    Asked     asked  = open_room(std::move(model), looking({0, 0, 0}, {0, 0, -1}));
    const Row rows[] = {
        {"a strip as wide as the pixel", {-5, 0.2, -4.55}, {3, 0.2, -2.95}, Point(3, 0.2, -2.95), be_a_point}};
    expect_answers(asked, "cube:size_px=64", rows);
}

// The picture ends where x = -z. With a margin of one pixel it ends at x = -z (1 + 1 / 32), with a quarter at 1.5.
TEST(HardRays, BeyondThePicturesBorder)
{
    Asked     asked = open_room(room(), looking({0, 0, 0}, {0, 0, -1}));
    const Row one[] = {
        {"the wall in the one column", {-2.1, 0.1, -8}, {7, 0.1, -7 / 1.015}, {}, be_a_point},
        {"the wall at the border", {-2.1, 0.1, -8}, {7, 0.1, -7}, {}, be_a_point},
        {"the wall beyond the column", {-2.1, 0.1, -8}, {7, 0.1, -7 / 1.05}, {}, be_open},
        {"the floor in the one row", {0.1, 1.1, -8}, {0.1, -3, -3 / 1.015}, {}, be_a_point},
    };
    expect_answers(asked, "wider:margin=0.01", one);
    // x = -2.1 + 9.1 s and -z = 8 - 3 s are equal at s = 10.1 / 12.1, exactly at the border; the wall is met at x / -z = 1.4.
    std::vector<Row> handed_on;
    for (const double share : {10.1 / 12.1, 10.1 / 12.1 - 1e-12, 10.1 / 12.1 + 1e-12, 0.9999})
        handed_on.push_back({"handed on", {-2.1, 0.1, -8}, {7, 0.5, -5}, {}, be_certain, share});
    expect_answers(asked, "wider", handed_on);
    expect_answers(asked, "cube:size_px=64", handed_on);
}

// A sheet without thickness at x = 2; an earlier camera looks at it from x = 6.5. From the rows' origins it is met or
// passed on the side that this camera does not see.
TEST(HardRays, BehindASheetThatHidesThemFromACameraElsewhere)
{
    Model model = room();
    model.materials.push_back(make_material("sheet", {0.5F, 0.5F, 0.5F}, 0, 1));
    model.materials[1].double_sided = true;
    model.meshes.push_back(make_quad({2, -2, 4}, {0, 0, -8}, {0, 5, 0}));
    model.meshes.back().material = 1;
    Asked asked                  = open_room(std::move(model), looking({0, 0, 0}, {0, 0, -1}));
    asked.context.earlier        = {looking({6.5, 0, 0}, {0, 0, 0})};
    const Row rows[]             = {
                    // It would meet the ceiling at x = 2.43, which that camera shows.
        {"pierces it from the unseen side", {1, -3, 0}, {2, 1.9, 0.5}, Point(2, 1.9, 0.5), be_no_other_point},
        {"pierces it from the seen side", {6, 4, 1}, {2, 0.5, 0}, Point(2, 0.5, 0), be_a_point},
        {"rises 2 cm before it", {2.02, -3, 1}, {2.02, 0, 1}, {}, be_a_point},
        {"rises 2 cm behind it", {1.98, -3, 1}, {1.98, 0, 1}, {}, be_no_other_point},
    };
    expect_answers(asked, "past:count=1:every=1", rows);
    asked.context.earlier.clear();
    const Row none[] = {{"no frame before", {1, -3, 0}, {2, 1.9, 0.5}, {}, be_open}};
    expect_answers(asked, "past:count=1:every=1", none);
}

// A block hides the begin of the ray from the earlier camera, which sees it end: it cannot vouch for what it saw.
TEST(HardRays, ThatEnterThePictureOfACameraElsewhereHaveAnUncertainAnswer)
{
    Model model = room();
    model.meshes.push_back(make_box({-4, -1, -3.2}, {-3.5, 1, -2.8}));
    Asked asked           = open_room(std::move(model), looking({0, 0, 0}, {0, 0, -1}));
    asked.context.earlier = {looking({0, 0, 0}, {0, 0, -1})};
    // At the block x / -z is -1.17: outside of the picture. The ray would meet the wall at x = 7.
    const Row            rows[] = {{"", {-5, 0, -3}, {-4, 0, -3}, Point(-4, 0, -3), be_open}};
    const auto           list   = parse_sources("past:count=1:every=1", "test");
    std::vector<OpenRay> rays   = {{0, rows[0].from, {1, 0, 0}, 5.8, 0, 1e9, 0}};
    asked.context.parameters    = list[0].values;
    EXPECT_FALSE(list[0].source->answer(asked.context, rays).answers[0].certain);
}

// The floor mirrors; the eye at its mirror image sees what the rays see, along each ray. Under the floor lies a slab that
// would hide the room from there, and the eye is inside of it. Bent normals turn the rays; the mirror stays flat.
TEST(HardRays, OfAFloorAreAnsweredByTheMirroredCameraUnderIt)
{
    for (const bool bent : {false, true}) {
        SCOPED_TRACE(bent ? "bent normals" : "flat");
        const double allowed     = bent ? 1.5 / 32 : 0.01; // rays that are not lines of sight are traced: to a pixel
        Model        model       = room();
        model.materials[0]       = make_material("wall", {0.5F, 0.5F, 0.5F}, 0, 1);
        model.meshes[0].material = 1;
        model.materials.push_back(make_material("mirror", {1, 1, 1}, 1, 0));
        model.meshes.push_back(make_box({-9, -9, -9}, {9, -3.2, 9}));
        if (bent)
            for (size_t i = 0; i < 4; ++i)
                model.meshes[0].vertices[i].normal_ws = glm::normalize(glm::vec3(0.1F * float(i) - 0.1F, 1, 0.05F));
        Stage stage = open_stage(device(), catalogue(), model_to_scene(std::move(model), "room"));
        show(stage, looking({0.3, 0.2, 1}, {0.1, -1.5, -3}));
        const Technique& hiz = technique("hiz");
        FrameSettings    settings;
        settings.trace          = in_sight;
        SourceContext context   = make_source_context(stage, hiz, values_of(hiz), settings);
        const auto    list      = parse_sources("planar", "test");
        context.parameters      = list[0].values;
        const SourceTurn turn   = list[0].source->answer(context, context.rays);
        size_t           points = 0, wrong = 0, certain_wrong = 0;
        for (size_t i = 0; i < context.rays.size(); ++i) {
            const RayAnswer& answer = turn.answers[i];
            if (answer.kind != AnswerKind::point) continue;
            const Point truth    = leaves_room(context.rays[i].origin_ws, context.rays[i].direction_ws);
            const bool  is_wrong = glm::length(answer.point_ws - truth) > allowed * glm::length(truth);
            ++points;
            wrong += is_wrong;
            certain_wrong += is_wrong && answer.certain;
        }
        ASSERT_GT(context.rays.size(), 1000U);
        // Rays that bent normals turn may leave the mirrored picture.
        EXPECT_GT(points, context.rays.size() * (bent ? 80 : 99) / 100);
        EXPECT_LE(wrong, points / 50); // where two walls meet, a pixel shows one of them
        EXPECT_EQ(certain_wrong, 0U);
    }
}

// A camera in a box sees its inside, and not through the sides that face away from it.
TEST(HardRays, AroundABoxThatHoldsTheCamera)
{
    Model model = room();
    model.meshes.push_back(make_box({2.5, -0.5, -0.5}, {3.5, 0.5, 0.5}));
    Asked     asked  = open_room(std::move(model), looking({3, 0, 0}, {0, 0, 0}));
    const Row rows[] = {
        {"toward the camera", {-5, 0.1, 0.2}, {0, 0.1, 0.2}, Point(2.5, 0.1, 0.2), be_no_other_point},
        {"through the box from behind", {7, 0.1, 0.2}, {5, 0.1, 0.2}, Point(3.5, 0.1, 0.2), be_no_other_point},
        {"past it, behind its sides", {1, -3, 0.1}, {1, 0, 0.1}, {}, be_no_other_point},
    };
    expect_answers(asked, "cube:size_px=64", rows);
}

// From the floor to the underside of a low table, in a scene that is 700 m long: the cells of its grid are long, too.
TEST(HardRays, ThatEndNearWhereTheyBeginPlaceAViewBesideThem)
{
    Model model = room();
    model.meshes.push_back(make_box({0, -2.2, -6}, {4, -2.1, -2}));
    model.meshes.push_back(make_box({699, 0, 0}, {700, 1, 1}));
    Asked            asked = open_room(std::move(model), looking({0, 0, 0}, {0, 0, -1}));
    std::vector<Row> rows;
    for (int i = 0; i < 64; ++i) {
        const Point from(0.5 + i % 8 * 0.4, -3, -5.5 + i / 8 * 0.4), under = from + Point(0.1, 0.8, -0.2);
        rows.push_back({"to the table", from, under, under, be_a_point});
    }
    expect_answers(asked, "views:size_px=64", rows);
}

// In a frame before, something stood elsewhere: its picture says nothing of now.
TEST(HardRays, PastFramesOfWhatMovesAreRefused)
{
    for (const bool turns : {false, true}) {
        Model model = room();
        model.meshes.push_back(make_box({-1, -1, -4}, {1, 1, -3}));
        (turns ? model.meshes.back().motion.turn_deg : model.meshes.back().motion.move_m) = {0, 1, 0};
        Asked asked               = open_room(std::move(model), looking({0, 0, 0}, {0, 0, -1}));
        asked.context.earlier     = {looking({0, 0, 0}, {0, 0, -1})};
        const auto           list = parse_sources("past:count=1:every=1", "test");
        std::vector<OpenRay> rays = {{0, {0, -3, -2}, {0, 0.7, -0.7}, 3, 0, 1e9, 0}};
        asked.context.parameters  = list[0].values;
        EXPECT_THROW(list[0].source->answer(asked.context, rays), Failure);
    }
}

// Two quads in one plane, of other triangles: they are one layer, so that the second one shows what they hide.
TEST(HardRays, MeetCoplanarLayersOnce)
{
    Model model = room();
    model.meshes.push_back(make_quad({-1, -1, -4}, {2, 0, 0}, {0, 2, 0}));
    model.meshes.push_back(make_quad({-1.3, -0.9, -4}, {2.2, 0, 0}, {0, 1.8, 0}));
    Asked     asked  = open_room(std::move(model), looking({0, 0, 0}, {0, 0, -1}));
    const Row rows[] = {{"both quads", {0, -3, -2}, {0.3, 0.2, -4}, Point(0.3, 0.2, -4), be_a_point},
                        {"one of them", {0, -3, -2}, {-1.2, 0.2, -4}, Point(-1.2, 0.2, -4), be_a_point},
                        {"the wall that they hide", {7, 0, -7.5}, {0.5, 0.2, -8}, {}, be_a_point}};
    expect_answers(asked, "layers:count=2:sides=front", rows);
}

// A probe's box is this room, each wall of which glows in a colour of its own: what it looks up is what the ray meets.
TEST(HardRays, ProbeShowsTheWallWhereTheRayLeavesTheRoom)
{
    Model model = room();
    for (uint32_t wall = 0; wall < 6; ++wall) {
        model.materials.push_back(make_material("glowing wall", {0, 0, 0}, 0, 1));
        model.materials.back().emissive = {0.1F * static_cast<float>(wall + 1), 0, 0};
        model.meshes[wall].material     = wall + 1;
    }
    const Point from{6, -2.9, 5};
    const Point through[]    = {{5, -3, 4}, {5.5, 4, 3}, {-5, -1, 2}, {7, 1, 4}, {6.5, 1, -8}, {3, -1, 6}};
    const float expected[]   = {0.1F, 0.2F, 0.3F, 0.4F, 0.5F, 0.6F}; // floor, ceiling, left, right, back, front
    Asked       asked        = open_room(std::move(model), looking({0, 0, 0}, {0, 0, -1}));
    const auto  list         = parse_sources("probe", "test");
    asked.context.parameters = list[0].values;
    std::vector<OpenRay> rays;
    for (const Point& to : through) rays.push_back({rays.size(), from, glm::normalize(to - from), 8, 0, 1e9, 0});
    const SourceTurn turn = list[0].source->answer(asked.context, rays);
    for (size_t i = 0; i < rays.size(); ++i) {
        SCOPED_TRACE(i);
        const RayAnswer& answer = turn.answers[i];
        EXPECT_EQ(answer.kind, AnswerKind::light);
        EXPECT_FALSE(answer.certain);
        EXPECT_NEAR(answer.light.x, expected[i], 0.02); // the walls reflect a little, too
        EXPECT_LT(glm::distance(answer.point_ws, leaves_room(from, rays[i].direction_ws)), 0.2);
    }
}

// A colour fills an open answer, is handed on like one, and gives way to every point.
TEST(Merging, LightWithoutAPointGivesWay)
{
    RayAnswer open{.kind = AnswerKind::open, .clear_m = 2}, light{.kind = AnswerKind::light, .light = {1, 0, 0}};
    RayAnswer point{.kind = AnswerKind::point}, nothing{.kind = AnswerKind::nothing};
    EXPECT_EQ(merged(open, light).kind, AnswerKind::light);
    EXPECT_EQ(merged(open, light).clear_m, 2);
    EXPECT_EQ(merged(light, point).kind, AnswerKind::point);
    EXPECT_EQ(merged(point, light).kind, AnswerKind::point);
    EXPECT_EQ(merged(nothing, light).kind, AnswerKind::nothing);
    nothing.certain = true;
    EXPECT_EQ(merged(light, nothing).kind, AnswerKind::nothing);
}

} // namespace
} // namespace ssrlab::test
