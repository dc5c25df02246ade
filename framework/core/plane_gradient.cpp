#include "core/plane_gradient.h"

#include "core/pixel_index.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace ssrlab {
namespace {

constexpr double   least_cosine = 0.02; // a plane that is seen more steeply counts as seen so
constexpr uint32_t no_plane     = 0xFFFFFFFF;

glm::dvec2 gradient_of_normal(const View& view, glm::ivec2 pixel, double depth, glm::dvec3 normal_vs)
{
    const bool       perspective = view.projection == Projection::perspective;
    const glm::dvec2 slope       = (glm::dvec2(pixel) + 0.5 - view.centre_px) / view.focal_px;
    const glm::dvec3 sight       = perspective ? glm::dvec3(slope.x, -slope.y, -1) : glm::dvec3(0, 0, -1);
    const double     least       = least_cosine * glm::length(sight) * glm::length(normal_vs);
    double           cosine      = glm::dot(normal_vs, sight);
    if (std::abs(cosine) < least) cosine = std::copysign(least, cosine);
    const glm::dvec2 across = glm::dvec2(normal_vs.x, -normal_vs.y) / view.focal_px / cosine;
    return perspective ? depth * across : across / (view.far_m - view.near_m);
}

} // namespace

uint32_t pack_gradient(glm::vec2 gradient)
{
    if (!std::isfinite(gradient.x) || !std::isfinite(gradient.y)) return no_plane;
    constexpr uint32_t half = 0x8000, upper = 0xFFFF0000;
    return ((std::bit_cast<uint32_t>(gradient.x) + half) & upper) |
           ((std::bit_cast<uint32_t>(gradient.y) + half) & upper) >> 16;
}

glm::vec2 unpack_gradient(uint32_t packed)
{
    return {std::bit_cast<float>(packed & 0xFFFF0000U), std::bit_cast<float>(packed << 16)};
}

void complete_gradients(GBufferImage& image)
{
    if (!image.gradient.empty()) return;
    image.gradient.resize(image.depth.size());
    for (size_t i = 0; i < image.depth.size(); ++i) {
        const float depth = image.depth[i];
        if (!(depth > 0)) continue;
        const double     limit    = image.view.projection == Projection::perspective ? double(depth) : 1;
        const glm::dvec2 gradient = gradient_of_normal(image.view, pixel_at(i, image.view.size_px), double(depth),
                                                       glm::dvec3(image.normal_vs[i]));
        const bool       usable   = std::isfinite(gradient.x) && std::isfinite(gradient.y);
        constexpr float  none     = std::numeric_limits<float>::quiet_NaN();
        image.gradient[i]         = unpack_gradient(pack_gradient(
                    usable ? glm::vec2(glm::clamp(gradient, glm::dvec2(-limit), glm::dvec2(limit))) : glm::vec2(none)));
    }
}

} // namespace ssrlab
