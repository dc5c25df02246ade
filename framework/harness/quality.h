// What the truths say about a run.
#pragma once

#include "compare/measures.h"
#include "harness/measured_run.h"
#include "scene/sequence.h"

#include <filesystem>
#include <optional>

namespace ssrlab {

/// The scene in a frame before the picture's, and what moved since.
struct SceneInTime {
    Scene       scene; // empty if no object moved
    FrameMotion motion;
};

/// The truths of one picture, for one trace settings at a time. All but make() throw Failure before it was called.
class Truths {
public:
    /// Keeps a reference to `scene`.
    Truths(const Scene& scene, GBufferImage gbuffer, std::filesystem::path cache_dir);

    /// Of the picture's layers behind the first, all that settings of make() ask for.
    void   know_layers(std::vector<GBufferImage> layers) { gbuffer_.layers = std::move(layers); }
    size_t known_layers() const { return gbuffer_.layers.size() + 1; }

    /// Makes the truths for these settings, or reads them from the cache, unless they are those of the last call; with what errors of
    /// images are measured against, or without.
    void make(const TraceSettings& settings, bool image_errors);

    /// What they are the truths of.
    const GBufferImage& gbuffer() const { return gbuffer_; }

    /// Every measure of `counted`. `twin` is the same trace in double, `hidden` what was found in the second layer; or null.
    MeasureValues compare(const TraceResult& counted, const TraceResult* twin, const TraceResult* hidden) const;

    /// The picture with the true reflections (truth/glossy_truth.h). Needs a scene truth.
    const Image& true_picture();

    /// Why there is no screen truth of these settings. Empty: there is one.
    static std::string without_screen(const TraceSettings& settings);
    /// Why there is no scene truth: a frame of another renderer has no triangles, or the driver draws another scene. Empty: there is one.
    const std::string& without_scene() const { return without_scene_; }
    /// The picture of true reflections that comes with such a frame, if one does. Throws where it has another size.
    std::optional<Image> given_picture() const;

    /// A finished picture against the one with the true reflection.
    MeasureValues compare_picture(const Image& picture, const Reference& reference) const;

    /// Where they differ, in false colours.
    Image flip_of(const Image& picture, const Reference& reference) const;

    bool has_reprojection() const { return before_.has_value(); }
    /// Where reflections were in the frame before, and ghost_frames before.
    void make_reprojection(const SceneInTime& before, const SceneInTime& earlier);
    /// What moved since the frame before, of a G-buffer with motion vectors. `found_px` as compare_reprojection() has it, or empty.
    MeasureValues compare_motion(const TraceResult& counted, std::span<const glm::vec2> found_px) const;
    MeasureValues compare_ghosts(const Image& picture, const Reference& reference) const;
    MeasureValues compare_converged(const Image& picture, const Reference& converged) const;

    /// The agreement with the scene truth, of a frame without triangles with the screen truth, as a false-colour picture. Empty without both.
    std::optional<Image> agreement(const TraceResult& counted) const;
    /// Why rays are wrong, likewise. Empty without a scene truth.
    std::optional<Image> causes(const TraceResult& counted) const;

private:
    const TraceSettings& made_for() const;
    SceneTruth           only_reflecting(const TraceSettings& settings) const;
    void                 make_scene_truth(const TraceSettings& settings);

    const Scene*                     scene_;
    GBufferImage                     gbuffer_;
    std::filesystem::path            cache_dir_;
    std::optional<TraceSettings>     made_for_;
    std::optional<TraceResult>       screen_truth_; // empty: the surface model has none
    SceneTruth                       scene_truth_;  // without one: which pixels reflect
    std::string                      without_scene_;
    MeasureValues                    depth_to_scene_;   // empty of a frame without triangles
    std::optional<Reference>         reference_;        // with image_errors: the scene truth's reflection
    std::optional<Image>             true_picture_;     // when asked for
    std::optional<ReprojectionTruth> before_, earlier_; // when asked for
};

/// $SSRLAB_CACHE, or .truth_cache beside the results folder.
std::filesystem::path truth_cache_dir(const std::filesystem::path& results);
/// Why truths cannot be kept there; empty: they can.
std::string cache_trouble(const std::filesystem::path& cache_dir);

/// The reflected radiance that a result finds: the G-buffer's at the hit pixel; the scene's background where nothing is hit.
Image reflected_image(const TraceResult& result, const GBufferImage& gbuffer, glm::vec3 background);

} // namespace ssrlab
