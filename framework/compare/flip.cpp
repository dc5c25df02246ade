#include "compare/flip.h"

#include "core/error.h"
#include "core/parallel_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace ssrlab {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

// Section 4.1 to 4.3 of the paper: exponent and range compression of the colour difference, feature size and exponent.
constexpr float qc = 0.7F, pc = 0.4F, pt = 0.95F, feature_width_deg = 0.082F, qf = 0.5F;

using Planes = std::array<Plane, 3>;

/// White point D65, matching the matrix.
const glm::vec3 white(0.950428545F, 1.0F, 1.088900371F);

glm::vec3 linear_rgb_to_xyz(glm::vec3 c)
{
    return {0.41238656F * c.r + 0.35759149F * c.g + 0.18045049F * c.b,
            0.21263682F * c.r + 0.71518298F * c.g + 0.0721802F * c.b,
            0.01933062F * c.r + 0.11919716F * c.g + 0.95037259F * c.b};
}

glm::vec3 xyz_to_linear_rgb(glm::vec3 c)
{
    static const glm::mat3 inverse = [] {
        glm::mat3 m;
        for (int i : {0, 1, 2}) m[i] = linear_rgb_to_xyz(glm::vec3(i == 0, i == 1, i == 2));
        return glm::inverse(m);
    }();
    return inverse * c;
}

glm::vec3 xyz_to_ycxcz(glm::vec3 xyz)
{
    const glm::vec3 n = xyz / white;
    return {116 * n.y - 16, 500 * (n.x - n.y), 200 * (n.y - n.z)};
}

glm::vec3 ycxcz_to_xyz(glm::vec3 c)
{
    const float y = (c.x + 16) / 116;
    return glm::vec3(y + c.y / 500, y, y - c.z / 200) * white;
}

glm::vec3 xyz_to_lab(glm::vec3 xyz)
{
    constexpr float delta = 6.0F / 29;
    const auto      f     = [](float t) {
        return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0F / 29;
    };
    const glm::vec3 n = xyz / white;
    return {116 * f(n.y) - 16, 500 * (f(n.x) - f(n.y)), 200 * (f(n.y) - f(n.z))};
}

/// Hunt effect: dark colours look less colourful.
glm::vec3 hunt_lab(glm::vec3 linear_rgb)
{
    const glm::vec3 lab = xyz_to_lab(linear_rgb_to_xyz(linear_rgb));
    return {lab.x, 0.01F * lab.x * lab.y, 0.01F * lab.x * lab.z};
}

float hyab(glm::vec3 a, glm::vec3 b) { return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z); }

/// Outside the mask `planes` stay as they are.
Planes to_ycxcz(const Image& image, Planes planes, const Mask& mask)
{
    parallel_pixels(image.size_px.x, image.size_px.y, [&](size_t i) {
        if (!is_inside(mask, i)) return;
        glm::vec3 linear;
        for (int c : {0, 1, 2}) linear[c] = srgb_to_linear(std::clamp(image.values[3 * i + size_t(c)], 0.0F, 1.0F));
        const glm::vec3 ycxcz = xyz_to_ycxcz(linear_rgb_to_xyz(linear));
        for (int c : {0, 1, 2}) planes[size_t(c)].values[i] = ycxcz[c];
    });
    return planes;
}

/// One term a sqrt(pi / b) exp(-pi^2 x^2 / b) of a contrast sensitivity function, x in degrees.
struct Sensitivity {
    float a, b;
};

std::vector<float> gaussian(float b, int radius, float pixels_per_degree)
{
    std::vector<float> kernel;
    for (int i = -radius; i <= radius; ++i) {
        const float x = float(i) / pixels_per_degree;
        kernel.push_back(std::exp(-pi * pi * x * x / b));
    }
    return kernel;
}

float sum(const std::vector<float>& values)
{
    float total = 0;
    for (float value : values) total += value;
    return total;
}

/// The kernel is a sum of Gaussians, each separable; normalised as a whole.
Plane blur(const Plane& plane, std::span<const Sensitivity> terms, int radius, float pixels_per_degree)
{
    Plane result{plane.size_px, std::vector<float>(plane.values.size())};
    float total = 0;
    for (const Sensitivity term : terms) {
        const std::vector<float> kernel = gaussian(term.b, radius, pixels_per_degree);
        const float              weight = term.a * std::sqrt(pi / term.b);
        const Plane              part   = filter_separable(plane, kernel, kernel);
        parallel_pixels(plane.size_px.x, plane.size_px.y,
                        [&](size_t i) { result.values[i] += weight * part.values[i]; });
        total += weight * sum(kernel) * sum(kernel);
    }
    parallel_pixels(plane.size_px.x, plane.size_px.y, [&](size_t i) { result.values[i] /= total; });
    return result;
}

/// What the eye resolves: achromatic, red-green and blue-yellow channels blurred by their sensitivities.
std::vector<glm::vec3> perceived_lab(const Planes& ycxcz, float pixels_per_degree, const Mask& mask)
{
    static constexpr std::array<Sensitivity, 1> achromatic{{{1, 0.0047F}}};
    static constexpr std::array<Sensitivity, 1> red_green{{{1, 0.0053F}}};
    static constexpr std::array<Sensitivity, 2> blue_yellow{{{34.1F, 0.04F}, {13.5F, 0.025F}}};
    const int              radius = int(std::ceil(3 * std::sqrt(0.04F / (2 * pi * pi)) * pixels_per_degree));
    const Plane            y      = blur(ycxcz[0], achromatic, radius, pixels_per_degree);
    const Plane            cx     = blur(ycxcz[1], red_green, radius, pixels_per_degree);
    const Plane            cz     = blur(ycxcz[2], blue_yellow, radius, pixels_per_degree);
    std::vector<glm::vec3> lab(y.values.size());
    parallel_pixels(y.size_px.x, y.size_px.y, [&](size_t i) {
        if (!is_inside(mask, i)) return;
        const glm::vec3 rgb = xyz_to_linear_rgb(ycxcz_to_xyz({y.values[i], cx.values[i], cz.values[i]}));
        lab[i]              = hunt_lab(glm::clamp(rgb, 0.0F, 1.0F));
    });
    return lab;
}

/// Positive and negative weights each sum to one.
void normalise_signed(std::vector<float>& kernel)
{
    float positive = 0, negative = 0;
    for (float weight : kernel) (weight > 0 ? positive : negative) += std::abs(weight);
    for (float& weight : kernel) weight /= weight > 0 ? positive : std::max(negative, 1e-30F);
}

/// Sets edges and points: lengths of the two-dimensional responses.
void detect_features(FlipView& view, const Mask& mask)
{
    const Plane&       y      = view.ycxcz[0];
    const float        sigma  = 0.5F * feature_width_deg * view.pixels_per_degree;
    const int          radius = int(std::ceil(3 * sigma));
    std::vector<float> flat, edge, point;
    for (int i = -radius; i <= radius; ++i) {
        const float x = float(i), g = std::exp(-x * x / (2 * sigma * sigma));
        flat.push_back(g);
        edge.push_back(-x * g);
        point.push_back((x * x / (sigma * sigma) - 1) * g);
    }
    for (auto* kernel : {&flat, &edge, &point}) normalise_signed(*kernel);
    Plane grey = y;
    parallel_pixels(y.size_px.x, y.size_px.y, [&](size_t i) { grey.values[i] = (y.values[i] + 16) / 116; });
    const auto response = [&](const std::vector<float>& kernel) {
        const Plane        across = filter_separable(grey, kernel, flat), down = filter_separable(grey, flat, kernel);
        std::vector<float> length(across.values.size());
        parallel_pixels(y.size_px.x, y.size_px.y, [&](size_t i) {
            if (is_inside(mask, i)) length[i] = std::hypot(across.values[i], down.values[i]);
        });
        return length;
    };
    view.edges  = response(edge);
    view.points = response(point);
}

/// Compresses the colour difference so that large ones take only the last twentieth of [0, 1].
float colour_error(float difference)
{
    static const float largest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), qc);
    const float        power   = std::pow(difference, qc);
    const float        knee    = pc * largest;
    return power < knee ? pt / knee * power : pt + (power - knee) / (largest - knee) * (1 - pt);
}

FlipView make_view(Planes ycxcz, float pixels_per_degree, const Mask& mask)
{
    FlipView view{pixels_per_degree, std::move(ycxcz), {}, {}, {}};
    view.lab = perceived_lab(view.ycxcz, pixels_per_degree, mask);
    detect_features(view, mask);
    return view;
}

} // namespace

void require_three_channels(const Image& image)
{
    const size_t expected = 3 * size_t(std::max(image.size_px.x, 0)) * size_t(std::max(image.size_px.y, 0));
    if (image.values.size() != expected)
        throw_failure("three channels are needed: an image of {}x{} has {} values", image.size_px.x, image.size_px.y,
                      image.values.size());
}

void require_same_size(glm::ivec2 a_px, glm::ivec2 b_px)
{
    if (a_px != b_px) throw_failure("what is compared has {}x{} and {}x{} pixels", a_px.x, a_px.y, b_px.x, b_px.y);
}

FlipView flip_view(const Image& image, float pixels_per_degree)
{
    require_three_channels(image);
    Planes planes;
    for (Plane& plane : planes) plane = {image.size_px, std::vector<float>(image.values.size() / 3)};
    return make_view(to_ycxcz(image, std::move(planes), {}), pixels_per_degree, {});
}

FlipView flip_view_inside(const Image& image, const FlipView& reference, const Mask& mask)
{
    require_three_channels(image);
    require_same_size(image.size_px, reference.ycxcz[0].size_px);
    return make_view(to_ycxcz(image, reference.ycxcz, mask), reference.pixels_per_degree, mask);
}

std::vector<float> flip_error(const FlipView& tested, const FlipView& reference, const Mask& mask)
{
    const FlipView & a = tested, &b = reference;
    const glm::ivec2 size_px = a.ycxcz[0].size_px;
    require_same_size(size_px, b.ycxcz[0].size_px);
    std::vector<float> error(a.lab.size());
    parallel_pixels(size_px.x, size_px.y, [&](size_t i) {
        if (!is_inside(mask, i)) return;
        const float colour = colour_error(hyab(a.lab[i], b.lab[i]));
        const float edges  = std::abs(a.edges[i] - b.edges[i]);
        const float points = std::abs(a.points[i] - b.points[i]);
        const float feature =
            std::pow(std::clamp(std::max(edges, points) / std::numbers::sqrt2_v<float>, 0.0F, 1.0F), qf);
        error[i] = std::clamp(std::pow(colour, 1 - feature), 0.0F, 1.0F);
    });
    return error;
}

} // namespace ssrlab
