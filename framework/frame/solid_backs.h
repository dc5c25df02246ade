// Where the solids end whose fronts the G-buffer shows (docs/reference/hit_contract.md, plane_solid). Folder-internal.
#pragma once

#include "frame/gbuffer.h"

namespace ssrlab {

/// Makes ready what record_solid_backs() needs and draws once, so that the first frame and the truths have solids; again it does nothing. A G-buffer that was not drawn from a scene keeps the solids that it has.
void prepare_solid_backs(Gpu& gpu, GBuffer& gbuffer);
/// Draws the scene once more, back faces included, behind what the G-buffer shows.
void record_solid_backs(const vk::raii::CommandBuffer& commands, const GBuffer& gbuffer);

} // namespace ssrlab
