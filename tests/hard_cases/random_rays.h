// The random campaign: pictures and rays in numbers that integers hold exactly, so that an oracle can judge them.
#pragma once

#include "check/setup.h"

#include <cstdint>

namespace ssrlab::test {

inline constexpr int px_steps    = 256;     // positions are multiples of 1/256 px
inline constexpr int depth_steps = 1 << 20; // depths are multiples of 2^-20

/// The slab's back lies at half the depth, exactly.
inline const TraceSettings campaign_settings =
    boxes({.thickness_m = 1, .thickness_relative = true, .max_distance_m = 1e9});

/// Rays of a campaign: what SSRLAB_LONG says, a hundred million if that is no number above 1; `short_run` without it.
size_t planned_rays(size_t short_run);

enum class Field { poles, sparse_poles, walls, terrain };
inline constexpr Field all_fields[] = {Field::poles, Field::sparse_poles, Field::walls, Field::terrain};

/// A picture without rays. Only its depth matters.
Setup make_field(Field field, glm::ivec2 size_px, uint32_t seed);

/// What an upload needs besides depth: black mirrors that face the camera.
void complete_field(GBufferImage& image);

/// Rays of all classes in turn: any direction, axis-aligned with either sign of zero, diagonal, rational slopes, almost
/// axis-aligned, level in depth, steep in depth, shorter than two pixels, along borders and through corners.
std::vector<RayInput> random_rays(glm::ivec2 size_px, size_t count, uint32_t seed);

} // namespace ssrlab::test
