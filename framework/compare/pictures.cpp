#include "compare/pictures.h"

#include "compare/measures.h"
#include "core/parallel_rows.h"
#include "core/pixel_index.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ssrlab {
namespace {

constexpr glm::vec3 black{0, 0, 0};
constexpr glm::vec3 green{0.05F, 0.5F, 0.05F};
constexpr glm::vec3 yellow{1, 0.8F, 0};
constexpr glm::vec3 red{0.9F, 0.02F, 0.02F};
constexpr glm::vec3 magenta{0.9F, 0, 0.9F};
constexpr glm::vec3 grey{0.15F, 0.15F, 0.18F};

template <typename ColourOf> Image paint(glm::ivec2 size_px, const ColourOf& colour_of)
{
    Image image;
    image.size_px  = size_px;
    image.channels = {"R", "G", "B"};
    image.values.resize(3 * pixel_count(size_px));
    parallel_pixels(size_px.x, size_px.y, [&](size_t i) {
        const glm::vec3 colour = colour_of(i);
        for (int c : {0, 1, 2}) image.values[3 * i + static_cast<size_t>(c)] = colour[c];
    });
    return image;
}

glm::vec3 agreement_colour(bool hit, bool findable, glm::dvec2 hit_px, glm::dvec2 true_px)
{
    if (hit && findable) return screen_distance_px(hit_px, true_px) <= within_one_px ? green : yellow;
    if (findable) return red;
    return hit ? magenta : grey;
}

glm::vec3 heat_colour(uint32_t fetches)
{
    if (fetches == 0) return black;
    constexpr std::array<glm::vec3, 5> ramp = {
        glm::vec3(0, 0, 0.1F), {0, 0.05F, 1}, {0, 0.8F, 0.8F}, {1, 0.8F, 0}, {0.9F, 0, 0}};
    const float place = std::min(std::log2(float(fetches)) / 3, 4.0F);
    const auto  low   = std::min(size_t(place), ramp.size() - 2);
    return glm::mix(ramp[low], ramp[low + 1], place - float(low));
}

} // namespace

Image agreement_picture(const TraceResult& tested, const TraceResult& truth)
{
    require_same_size(tested.size_px, truth.size_px);
    return paint(tested.size_px, [&](size_t i) {
        if (truth.status[i] == TraceStatus::not_traced) return black;
        return agreement_colour(tested.status[i] == TraceStatus::hit, truth.status[i] == TraceStatus::hit,
                                glm::dvec2(tested.hit_px_depth[i]), glm::dvec2(truth.hit_px_depth[i]));
    });
}

Image agreement_picture(const TraceResult& tested, const SceneTruth& truth)
{
    require_same_size(tested.size_px, truth.size_px);
    return paint(tested.size_px, [&](size_t i) {
        if (truth.cls[i] == TruthClass::not_traced) return black;
        return agreement_colour(tested.status[i] == TraceStatus::hit, truth.cls[i] == TruthClass::visible,
                                glm::dvec2(tested.hit_px_depth[i]), truth.point_px[i]);
    });
}

Image fetch_heat_map(const TraceResult& tested)
{
    return paint(tested.size_px, [&](size_t i) {
        return heat_colour(tested.depth_fetches.empty() ? tested.steps[i]
                                                        : tested.depth_fetches[i] + structure_fetches_of(tested, i));
    });
}

} // namespace ssrlab
