// The layers behind a G-buffer that enter the walk (docs/reference/hit_contract.md). Folder-internal.
#pragma once

#include "frame/gbuffer.h"

namespace ssrlab {

/// Makes those that `settings` asks for and the G-buffer lacks, and draws them once, so that the first frame and the truths have them.
/// A G-buffer that was not drawn from a scene has those that it came with; others are empty.
void prepare_layers(Gpu& gpu, GBuffer& gbuffer, const TraceSettings& settings);
/// Draws the scene once more for each.
void record_layers(const vk::raii::CommandBuffer& commands, const GBuffer& gbuffer, const TraceSettings& settings);

/// Layer 1, layer 2 … by the names that shaders give their images.
void add_layers(Bindings& bindings, std::span<const GBufferPtr> layers);

} // namespace ssrlab
