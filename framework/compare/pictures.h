// Pictures in false colours that show where a technique errs and where it works hard. Colours are linear.
#pragma once

#include "core/gbuffer_image.h"
#include "core/image.h"
#include "core/ray_answer.h"
#include "core/trace_image.h"
#include "core/truth_class.h"

#include <span>

namespace ssrlab {

/// not traced      black
/// correct         green    found within 1 px
/// displaced       yellow   hit farther than 1 px from where it should be
/// missed          orange   no hit where there is one
/// false           pink     hit where there is none
/// not answerable  grey     no hit, and none to be found
Image agreement_picture(const TraceImage& tested, const TraceImage& screen_truth);
Image agreement_picture(const TraceImage& tested, const SceneTruth& scene_truth);

/// Shows why rays are wrong (compare/causes.h): own surface orange, not shown light blue, thin yellow, silhouette pink,
/// edge green, stopped orange-red, other white; right grey.
Image causes_picture(const TraceImage& tested, const SceneTruth& scene_truth, const GBufferImage& gbuffer);

/// Shows which source answered each ray rightly (compare/all_rays.h), by its place in the list: green, light blue,
/// yellow, pink, then orange. A wrong point is orange-red; a ray without an answer is white if it meets geometry, else
/// grey.
Image sources_picture(std::span<const RayAnswer> answers, const SceneTruth& scene_truth, const GBufferImage& gbuffer);

/// Shows the fetches of each ray (steps, if fetches were not counted) on a fixed logarithmic scale: black 0, dark
/// violet 1, violet 8, pink 64, orange 512, pale yellow 4096 and more.
Image fetch_heat_map(const TraceImage& tested);

/// Shows FLIP of each pixel inside the mask on the same colours from 0 to 1; black outside.
Image flip_picture(glm::ivec2 size_px, const std::vector<float>& flip, const std::vector<uint8_t>& mask);

} // namespace ssrlab
