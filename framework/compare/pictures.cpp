#include "compare/pictures.h"

#include "compare/all_rays.h"
#include "compare/causes.h"
#include "compare/image_filter.h"
#include "compare/measures.h"
#include "core/parallel_rows.h"
#include "core/pixel_index.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ssrlab {
namespace {

constexpr glm::vec3 black{0, 0, 0};

glm::vec3 from_srgb(int r, int g, int b)
{
    return {srgb_to_linear(float(r) / 255), srgb_to_linear(float(g) / 255), srgb_to_linear(float(b) / 255)};
}

// Okabe and Ito 2008: told apart by the colour-blind. experiments/plots/report.py has the same for its legend.
const glm::vec3 green = from_srgb(0x00, 0x9e, 0x73), yellow = from_srgb(0xf0, 0xe4, 0x42),
                vermilion = from_srgb(0xd5, 0x5e, 0x00), pink = from_srgb(0xcc, 0x79, 0xa7),
                grey = from_srgb(0x6b, 0x6b, 0x74), orange = from_srgb(0xe6, 0x9f, 0x00),
                sky_blue = from_srgb(0x56, 0xb4, 0xe9), white = from_srgb(0xff, 0xff, 0xff);

/// Magma (Smith and van der Walt 2015) without its darkest end, which is kept for pixels that have no value. From 0 to 1.
glm::vec3 ramp_colour(float value)
{
    static const std::array<glm::vec3, 5> ramp  = {from_srgb(0x1d, 0x11, 0x47), from_srgb(0x51, 0x12, 0x7c),
                                                   from_srgb(0xb7, 0x37, 0x79), from_srgb(0xfc, 0x89, 0x61),
                                                   from_srgb(0xfc, 0xfd, 0xbf)};
    const float                           place = 4 * std::clamp(value, 0.0F, 1.0F);
    const auto                            low   = std::min(size_t(place), ramp.size() - 2);
    return glm::mix(ramp[low], ramp[low + 1], place - float(low));
}

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
    if (findable) return vermilion;
    return hit ? pink : grey;
}

glm::vec3 heat_colour(uint32_t fetches) { return fetches == 0 ? black : ramp_colour(std::log2(float(fetches)) / 12); }

} // namespace

Image agreement_picture(const TraceImage& tested, const TraceImage& truth)
{
    require_same_size(tested.size_px, truth.size_px);
    return paint(tested.size_px, [&](size_t i) {
        if (truth.status[i] == TraceStatus::not_traced) return black;
        return agreement_colour(tested.status[i] == TraceStatus::hit, truth.status[i] == TraceStatus::hit,
                                glm::dvec2(tested.hit_px_depth[i]), glm::dvec2(truth.hit_px_depth[i]));
    });
}

Image agreement_picture(const TraceImage& tested, const SceneTruth& truth)
{
    require_same_size(tested.size_px, truth.size_px);
    return paint(tested.size_px, [&](size_t i) {
        if (truth.cls[i] == TruthClass::not_traced) return black;
        return agreement_colour(tested.status[i] == TraceStatus::hit, truth.cls[i] == TruthClass::visible,
                                glm::dvec2(tested.hit_px_depth[i]), truth.point_px[i]);
    });
}

Image causes_picture(const TraceImage& tested, const SceneTruth& truth, const GBufferImage& gbuffer)
{
    // In the order of WrongCause.
    const std::array<glm::vec3, wrong_cause_names.size()> colours = {grey, orange, sky_blue,  yellow,
                                                                     pink, green,  vermilion, white};
    const std::vector<WrongCause>                         causes  = wrong_causes(tested, truth, gbuffer);
    return paint(tested.size_px,
                 [&](size_t i) { return truth.cls[i] == TruthClass::not_traced ? black : colours[size_t(causes[i])]; });
}

Image sources_picture(std::span<const RayAnswer> answers, const SceneTruth& truth, const GBufferImage& gbuffer)
{
    const std::array of_source = {green, sky_blue, yellow, pink, orange};
    return paint(truth.size_px, [&](size_t i) {
        if (truth.cls[i] == TruthClass::not_traced) return black;
        if (is_right(answers[i], truth, gbuffer, i))
            return of_source[std::min<size_t>(answers[i].source, of_source.size() - 1)];
        if (answers[i].kind == AnswerKind::point) return vermilion;
        return meets_geometry(truth.cls[i]) ? white : grey;
    });
}

Image fetch_heat_map(const TraceImage& tested)
{
    return paint(tested.size_px, [&](size_t i) {
        return heat_colour(tested.depth_fetches.empty() ? tested.steps[i]
                                                        : tested.depth_fetches[i] + structure_fetches_of(tested, i));
    });
}

Image flip_picture(glm::ivec2 size_px, const std::vector<float>& flip, const std::vector<uint8_t>& mask)
{
    return paint(size_px, [&](size_t i) { return mask[i] == 0 ? black : ramp_colour(flip[i]); });
}

} // namespace ssrlab
