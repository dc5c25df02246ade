// Truths on disk, named by a hash of everything they depend on: a sweep computes each one once.
#pragma once

#include "truth/glossy_truth.h"
#include "truth/scene_truth.h"
#include "truth/screen_truth.h"

#include <filesystem>

namespace ssrlab {

/// Like screen_truth(), scene_truth() and glossy_truth(), but reads the result from cache_dir if it is there and
/// intact. A damaged file is computed anew, and a file that cannot be written is not an error. Files appear whole or
/// not at all, so processes may share the folder. An empty cache_dir stands for no cache.
TraceImage cached_screen_truth(const std::filesystem::path& cache_dir, const GBufferImage& gbuffer,
                               const TraceSettings& settings, unsigned threads = 0);

/// Builds the hierarchy only if the truth is not in the cache.
SceneTruth  cached_scene_truth(const std::filesystem::path& cache_dir, const Scene& scene, const GBufferImage& gbuffer,
                               const TraceSettings& settings, unsigned threads = 0);
GlossyTruth cached_glossy_truth(const std::filesystem::path& cache_dir, const Scene& scene, const GBufferImage& gbuffer,
                                const TraceSettings& settings, const GlossySettings& glossy, unsigned threads = 0);

/// Returns 32 hexadecimal digits that depend on all that bounced_light() reads of a scene.
std::string bounced_light_key(const Scene& scene);

} // namespace ssrlab
