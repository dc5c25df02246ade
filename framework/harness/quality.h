// Judging runs by the truths of their frame.
#pragma once

#include "compare/measures.h"
#include "harness/measured_run.h"
#include "scene/sequence.h"
#include "truth/glossy_truth.h"

#include <filesystem>
#include <optional>

namespace ssrlab {

/// The scene in an earlier frame, and what moved since.
struct SceneInTime {
    Scene       scene; // empty if no object moved
    FrameMotion motion;
};

/// The truths of one frame, for one TraceSettings at a time. Before make(), all other functions throw Failure.
class Truths {
public:
    /// Keeps a reference to `scene`. An empty cache_dir stands for no cache. metallic_exponent: of the true picture, as
    /// GlossySettings has it.
    Truths(const Scene& scene, GBufferImage gbuffer, std::filesystem::path cache_dir,
           std::optional<float> metallic_exponent = {});

    /// Adds the layers behind the first, as many as the settings of make() will ask for.
    void   know_layers(std::vector<GBufferImage> layers) { gbuffer_.layers = std::move(layers); }
    size_t known_layers() const { return gbuffer_.layers.size() + 1; }

    /// Makes the truths for these settings or reads them from the cache; does nothing if the settings are those of the
    /// last call. `image_errors`: also prepares the reference for image errors.
    void make(const TraceSettings& settings, bool image_errors);

    /// Returns the G-buffer of the truths.
    const GBufferImage& gbuffer() const { return gbuffer_; }

    /// Returns every measure of `counted`. `twin`: the trace in double; `hidden`: hits in the second layer; or null.
    MeasureValues compare(const TraceImage& counted, const TraceImage* twin, const TraceImage* hidden) const;

    /// Returns the truth of every reflecting pixel; without_scene() says whether it has true points.
    const SceneTruth& scene_truth() const;

    /// Returns the image with the true reflections (truth/glossy_truth.h). Needs a scene truth.
    const Image& true_picture();
    /// Returns it as a reference whose noise is known. Needs a scene truth.
    Reference true_reference();

    /// Returns why there is no screen truth for these settings; empty if there is one.
    static std::string without_screen(const TraceSettings& settings);
    /// Returns why there is no scene truth (no triangles, or the driver draws other depths); empty if there is one.
    const std::string& without_scene() const { return without_scene_; }
    /// Returns the reference picture of a frame file, if it has one. Throws if its size differs.
    std::optional<Image> given_picture() const;

    /// Compares a finished picture with the one with the true reflection.
    MeasureValues compare_picture(const Image& picture, const Reference& reference) const;

    /// Returns their difference in false colours.
    Image flip_of(const Image& picture, const Reference& reference) const;

    bool has_reprojection() const { return before_.has_value(); }
    /// Makes the truth of where reflections were in the frame before, and ghost_frames earlier.
    void make_reprojection(const SceneInTime& before, const SceneInTime& earlier);
    /// Returns the measures of motion, from motion vectors. `found_px`: as in compare_reprojection(), or empty.
    MeasureValues compare_motion(const TraceImage& counted, std::span<const glm::vec2> found_px) const;
    MeasureValues compare_ghosts(const Image& picture, const Reference& reference) const;
    MeasureValues compare_converged(const Image& picture, const Reference& converged) const;

    /// Returns the agreement with the scene truth, or else the screen truth, in false colours; nullopt without both.
    std::optional<Image> agreement(const TraceImage& counted) const;
    /// Returns why rays are wrong, in false colours; nullopt without a scene truth.
    std::optional<Image> causes(const TraceImage& counted) const;

private:
    const TraceSettings& made_for() const;
    SceneTruth           only_reflecting(const TraceSettings& settings) const;
    void                 make_scene_truth(const TraceSettings& settings);

    const Scene*                     scene_;
    GBufferImage                     gbuffer_;
    std::filesystem::path            cache_dir_;
    std::optional<float>             metallic_exponent_;
    std::optional<TraceSettings>     made_for_;
    std::optional<TraceImage>        screen_truth_; // empty if the surface model has none
    SceneTruth                       scene_truth_;  // without triangles: only which pixels reflect
    std::string                      without_scene_;
    MeasureValues                    depth_to_scene_;   // empty without triangles
    std::optional<Reference>         reference_;        // with image_errors: the scene truth's reflection
    std::optional<GlossyTruth>       glossy_;           // once asked for
    std::optional<Image>             true_picture_;     // likewise
    std::optional<ReprojectionTruth> before_, earlier_; // once asked for
};

/// Returns GlossySettings::metallic_exponent for these values of [passes].
std::optional<float> metallic_exponent_of(const ParameterValues& passes);

/// Returns $SSRLAB_CACHE, or .truth_cache beside the results folder.
std::filesystem::path truth_cache_dir(const std::filesystem::path& results);
/// Returns why truths cannot be written there; empty if they can.
std::string cache_trouble(const std::filesystem::path& cache_dir);

/// Returns the reflected radiance of a result: the G-buffer's at the hit pixel, or the background for a miss.
Image reflected_image(const TraceImage& result, const GBufferImage& gbuffer, glm::vec3 background);

} // namespace ssrlab
