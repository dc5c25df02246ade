// The choices of the passes' parameters: enums in C++, and the same names in specifications and shaders.
#pragma once

#include "trace/technique.h"

#include <string_view>

namespace ssrlab {

/// The parameter's name, and the names of its choices with ", " between them.
struct ChoiceNames {
    std::string_view parameter, choices;
};

/// An enum and its choice_names(), from one list. Shaders get a constant PARAMETER_CHOICE for each value.
#define PASS_CHOICE(Enum, parameter, ...) \
    enum class Enum { __VA_ARGS__ };      \
    constexpr ChoiceNames choice_names(Enum /*any*/) { return {#parameter, #__VA_ARGS__}; }

PASS_CHOICE(PassSet, pass_set, all, shading)
PASS_CHOICE(TraceResolution, trace_resolution, full, half, quarter)
PASS_CHOICE(RayList, ray_list, rays, pixels)
PASS_CHOICE(HitShading, hit_shading, diffuse, lit, mirrored)
PASS_CHOICE(ViewerFade, viewer_fade, off, linear, cut, smooth)
PASS_CHOICE(EdgeFade, edge_fade, off, manhattan, linear, squared, border)
PASS_CHOICE(FadeOperator, fade_operator, product, minimum)
PASS_CHOICE(Attenuation, attenuation, off, inverse, inverse_square)
PASS_CHOICE(BounceMode, bounce_mode, off, history, direct)
PASS_CHOICE(BlurOrder, blur_order, after_upsampling, before_upsampling)
PASS_CHOICE(Filter3x3, filter_3x3, off, box3, median3)
PASS_CHOICE(Gloss, gloss, off, blur, cone, stochastic)
PASS_CHOICE(MissLight, miss_light, environment, triangles, rooms)
PASS_CHOICE(Reflectance, reflectance, metallic, ggx)
PASS_CHOICE(HistoryClamping, history_clamping, off, minmax, variance)

#undef PASS_CHOICE

/// The choice that these values hold: choice<Gloss>(values) == Gloss::cone.
template <typename Enum> Enum choice(const ParameterValues& values)
{
    return static_cast<Enum>(static_cast<int>(values.at(std::string(choice_names(Enum{}).parameter))));
}

/// Returns the number that stores a choice.
template <typename Enum> constexpr double choice_value(Enum chosen) { return static_cast<double>(chosen); }

/// Returns parameter and value of a choice, for a ParameterValues.
template <typename Enum> ParameterValues::value_type chosen(Enum value)
{
    return {std::string(choice_names(value).parameter), choice_value(value)};
}

/// Returns whether rays of rough surfaces are drawn from their lobes, for the pass ray_reuse.
inline bool draws_lobe_rays(const ParameterValues& values)
{
    return choice<Gloss>(values) == Gloss::stochastic && choice<PassSet>(values) == PassSet::all;
}

/// Returns the side in pixels of the blocks in which one pixel has rays.
inline int trace_block_px(const ParameterValues& values)
{
    return 1 << static_cast<int>(choice<TraceResolution>(values));
}

} // namespace ssrlab
