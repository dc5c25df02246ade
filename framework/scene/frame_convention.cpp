#include "scene/frame_convention.h"

#include "core/error.h"
#include "core/files.h"
#include "scene/frame_channels.h"
#include "scene/toml_table.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>

namespace ssrlab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// `count` numbers of an attribute that ssrlab wrote.
std::vector<double> numbers(const ExrFile& file, const std::string& name, size_t count)
{
    std::istringstream  text(file.attributes.at(name));
    std::vector<double> values;
    for (std::string word; text >> word;) values.push_back(std::strtod(word.c_str(), nullptr));
    if (values.size() != count)
        throw_failure("{}: attribute '{}': expected {} numbers, got '{}'", file.shown, name, count,
                      file.attributes.at(name));
    return values;
}

/// Other programs keep attributes when they resize or crop a picture. What a pixel spans then differs.
void check_size(const ExrFile& file, const FrameConvention& convention)
{
    if (!file.attributes.contains("ssrlab:view_to_clip")) return;
    const auto       matrix = numbers(file, "ssrlab:view_to_clip", 16);
    const glm::dvec2 scale(matrix[0], -matrix[5]); // as view_to_clip() has it
    const glm::dvec2 size_px = glm::round(2.0 * convention.view.focal_px / scale);
    if (size_px == glm::dvec2(file.size_px)) return;
    throw_spec_error(
        "{}: {}x{} pixels, expected {}x{} as its ssrlab attributes say: resized or cropped since; say what "
        "the camera sees in {}, [camera]",
        file.shown, file.size_px.x, file.size_px.y, size_px.x, size_px.y, convention.place);
}

void read_attributes(const ExrFile& file, FrameConvention& convention)
{
    for (const char* name : {"world_to_view", "focal_px", "centre_px", "near_m", "far_m"})
        if (!file.attributes.contains(std::string("ssrlab:") + name)) return;
    View&      view   = convention.view;
    const auto matrix = numbers(file, "ssrlab:world_to_view", 16);
    for (int i = 0; i < 16; ++i) view.world_to_view[i / 4][i % 4] = matrix[static_cast<size_t>(i)];
    const auto focal = numbers(file, "ssrlab:focal_px", 2), centre = numbers(file, "ssrlab:centre_px", 2);
    view.focal_px           = {focal[0], focal[1]};
    view.centre_px          = {centre[0], centre[1]};
    view.near_m             = numbers(file, "ssrlab:near_m", 1)[0];
    const double far_m      = numbers(file, "ssrlab:far_m", 1)[0];
    view.projection         = std::isinf(far_m) ? Projection::perspective : Projection::orthographic;
    view.far_m              = std::isinf(far_m) ? View{}.far_m : far_m;
    convention.depth        = DepthKind::reversed;
    convention.device_far_m = far_m;
    convention.has_axes     = true;
    convention.normal_space = "view";
}

glm::dvec3 unit(TomlTable& table, const char* key, glm::dvec3 value)
{
    if (std::abs(glm::length(value) - 1) > 1e-3) table.fail(key, "must be a direction of length 1");
    return glm::normalize(value);
}

/// Rows of the rotation are the camera's axes in the world, of either handedness.
void read_axes(TomlTable& table, FrameConvention& convention)
{
    const auto right = table.vector("right"), up = table.vector("up"), forward = table.vector("forward");
    const auto position = table.vector("position").value_or(glm::dvec3(0));
    if (!right && !up && !forward) return;
    if (!right || !up || !forward) table.fail("'right', 'up' and 'forward' must be given together");
    const glm::dvec3 rows[] = {unit(table, "right", *right), unit(table, "up", *up), -unit(table, "forward", *forward)};
    for (int a = 0; a < 3; ++a) {
        if (std::abs(glm::dot(rows[a], rows[(a + 1) % 3])) > 1e-3)
            table.fail("'right', 'up' and 'forward' must be at right angles");
        for (int column = 0; column < 3; ++column) convention.view.world_to_view[column][a] = rows[a][column];
        convention.view.world_to_view[3][a] = -glm::dot(rows[a], position);
    }
    convention.has_axes = true;
}

void read_camera(TomlTable table, const ExrFile& file, FrameConvention& convention)
{
    const glm::ivec2 size_px = file.size_px;
    View&            view    = convention.view;
    view                     = View{};
    convention.has_axes      = false;
    view.projection = static_cast<Projection>(table.choice("projection", {"perspective", "orthographic"}).value_or(0));
    const bool   flat  = view.projection == Projection::orthographic;
    const auto   fov_y = table.number("fov_y_deg", 0.01, 179), fov_x = table.number("fov_x_deg", 0.01, 179);
    const auto   height = table.number("height_m", 1e-6, 1e9);
    const auto   near_m = table.number("near_m", 1e-6, 1e9), far_m = table.number("far_m", 1e-6, 1e12);
    const double shift_x = table.number("shift_x_px", -1e6, 1e6).value_or(0);
    const double shift_y = table.number("shift_y_px", -1e6, 1e6).value_or(0);
    if (!near_m) table.fail("'near_m' is needed: the distance of the near plane");
    if (flat && (!height || !far_m)) table.fail("an orthographic camera needs 'height_m' and 'far_m'");
    if (!flat && fov_y.has_value() == fov_x.has_value()) table.fail("expected one of 'fov_y_deg' and 'fov_x_deg'");
    const auto focal = [](double fov_deg, int px) {
        return 0.5 * px / std::tan(0.5 * fov_deg * std::numbers::pi / 180);
    };
    const double focal_y = flat    ? size_px.y / *height
                           : fov_y ? focal(*fov_y, size_px.y)
                                   : focal(*fov_x, size_px.x) * file.pixel_aspect;
    view.focal_px        = {focal_y / file.pixel_aspect, focal_y};
    view.centre_px       = 0.5 * glm::dvec2(size_px) + glm::dvec2(shift_x, shift_y);
    view.near_m          = *near_m;
    if (flat) view.far_m = *far_m;
    if (far_m && *far_m <= *near_m) table.fail("far_m", "must be more than near_m");
    convention.device_far_m = far_m.value_or(infinity);
    read_axes(table, convention);
    table.refuse_unknown_keys();
}

void read_depth_table(TomlTable table, FrameConvention& convention)
{
    const auto kind = table.choice("kind", {"reversed", "standard", "distance", "ray_distance"});
    if (!kind) table.fail("'kind' is needed: reversed, standard, distance or ray_distance");
    convention.depth        = static_cast<DepthKind>(*kind);
    convention.unit_m       = table.number("unit_m", 1e-9, 1e9).value_or(1);
    convention.background   = table.any_number("background");
    convention.background_m = table.number("background_m", 0, 1e30).value_or(convention.background_m);
    table.refuse_unknown_keys();
}

void read_normals_table(TomlTable table, FrameConvention& convention)
{
    if (const auto space = table.choice("space", {"view", "world"}))
        convention.normal_space = *space == 0 ? "view" : "world";
    convention.unsigned_normals = table.flag("unsigned").value_or(false);
    for (const char axis : table.text("flip").value_or("")) {
        if (axis < 'x' || axis > 'z') table.fail("flip", "must name axes, such as \"z\" or \"xy\"");
        convention.normal_sign[axis - 'x'] = -1;
    }
    table.refuse_unknown_keys();
}

void read_quantities(TomlTable& root, FrameConvention& convention)
{
    if (auto table = root.table("channels")) {
        for (const char* quantity : frame_quantities)
            if (const auto name = table->text(quantity)) convention.channels[quantity] = *name;
        table->refuse_unknown_keys();
    }
    if (auto table = root.table("values")) {
        for (const char* quantity : {"roughness", "metallic"})
            if (const auto value = table->number(quantity, 0, 1)) convention.values[quantity] = *value;
        if (const auto colour = table->colour("base_colour"))
            for (int c = 0; c < 3; ++c) convention.values[std::string("base_colour.") + "RGB"[c]] = (*colour)[c];
        table->refuse_unknown_keys();
    }
}

} // namespace

std::filesystem::path convention_file(const std::filesystem::path& exr) { return exr.string() + ".toml"; }

FrameConvention read_convention(const ExrFile& file)
{
    FrameConvention convention;
    const auto      path = convention_file(file.path);
    convention.place     = short_path(path);
    read_attributes(file, convention);
    bool has_camera = false;
    if (std::filesystem::exists(path)) {
        const TomlFile parsed = read_toml(path);
        TomlTable      root(parsed, parsed.root, "frame");
        has_camera = root.has("camera");
        if (auto table = root.table("camera")) read_camera(*table, file, convention);
        if (auto table = root.table("depth")) read_depth_table(*table, convention);
        if (auto table = root.table("normals")) read_normals_table(*table, convention);
        read_quantities(root, convention);
        if (const auto picture = root.text("reference")) convention.reference = path.parent_path() / *picture;
        if (!convention.reference.empty() && !std::filesystem::exists(convention.reference))
            root.fail("reference",
                      fmt::format("must be a picture that is there, not {}", convention.reference.string()));
        root.refuse_unknown_keys();
    }
    if (!has_camera && convention.depth) check_size(file, convention);
    convention.view.name    = Camera{}.name;
    convention.view.size_px = file.size_px;
    if (!(convention.device_far_m > 0))
        throw_spec_error(
            "{}: nothing says how the camera looks: write {} with [camera] (docs/reference/frame_files.md)", file.shown,
            convention.place);
    if (!convention.depth)
        throw_spec_error(
            "{}: nothing says what depth means: write {} with [depth] kind (docs/reference/frame_files.md)", file.shown,
            convention.place);
    return convention;
}

} // namespace ssrlab
