// Truths on disk, named by a hash of everything they depend on: a sweep computes each one once.
#pragma once

#include "truth/glossy_truth.h"
#include "truth/scene_truth.h"
#include "truth/screen_truth.h"

#include <filesystem>

namespace ssrlab {

/// As screen_truth, scene_truth and glossy_truth, but read from cache_dir when it is there and intact. A damaged file is computed anew; a file that
/// cannot be written is no error, for the result is right without it. Files appear whole or not at all, so that processes may
/// share the folder.
TraceResult cached_screen_truth(const std::filesystem::path& cache_dir, const GBufferImage& gbuffer,
                                const TraceSettings& settings, unsigned threads = 0);

/// Builds the scene's hierarchy only when the truth is not in the cache.
SceneTruth  cached_scene_truth(const std::filesystem::path& cache_dir, const Scene& scene, const GBufferImage& gbuffer,
                               const TraceSettings& settings, unsigned threads = 0);
GlossyTruth cached_glossy_truth(const std::filesystem::path& cache_dir, const Scene& scene, const GBufferImage& gbuffer,
                                const TraceSettings& settings, const GlossySettings& glossy, unsigned threads = 0);

} // namespace ssrlab
