#include "harness/quality.h"

#include "compare/causes.h"
#include "compare/image_io.h"
#include "compare/pictures.h"
#include "compare/validate_result.h"
#include "core/error.h"
#include "core/files.h"
#include "core/parallel_rows.h"
#include "core/pixel_index.h"
#include "frame/passes/choices.h"
#include "truth/pixel_surface.h"
#include "truth/reprojection_truth.h"
#include "truth/screen_ray.h"
#include "truth/truth_cache.h"

#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <unistd.h>

namespace ssrlab {
std::filesystem::path truth_cache_dir(const std::filesystem::path& results)
{
    const char* variable = std::getenv("SSRLAB_CACHE");
    if (variable != nullptr && *variable != '\0') return variable;
    return std::filesystem::absolute(results).lexically_normal().parent_path() / ".truth_cache";
}

std::string cache_trouble(const std::filesystem::path& cache_dir)
{
    std::error_code error;
    std::filesystem::create_directories(cache_dir, error);
    if (!error && ::access(cache_dir.c_str(), R_OK | W_OK | X_OK) != 0) error = {errno, std::generic_category()};
    if (!error) return "";
    return fmt::format("{}: truths are computed anew, without a cache: {}", short_path(cache_dir), error.message());
}

Image reflected_image(const TraceImage& result, const GBufferImage& gbuffer, glm::vec3 background)
{
    require_possible(result);
    Image image{result.size_px, {"R", "G", "B"}, std::vector<float>(result.status.size() * 3), {}};
    parallel_pixels(result.size_px.x, result.size_px.y, [&](size_t i) {
        glm::vec3 colour(0);
        if (result.status[i] == TraceStatus::hit) {
            const size_t pixel = pixel_index(result.hit_pixel[i], result.size_px);
            colour             = layer_of(gbuffer, result.hit_layer[i]).radiance[pixel];
        } else if (result.status[i] != TraceStatus::not_traced) {
            colour = background;
        }
        for (int c : {0, 1, 2}) image.values[3 * i + static_cast<size_t>(c)] = colour[c];
    });
    return image;
}

std::optional<float> metallic_exponent_of(const ParameterValues& passes)
{
    if (choice<Reflectance>(passes) != Reflectance::metallic) return std::nullopt;
    return float(passes.at("metallic_exponent"));
}

Truths::Truths(const Scene& scene, GBufferImage gbuffer, std::filesystem::path cache_dir,
               std::optional<float> metallic_exponent)
    : scene_(&scene), gbuffer_(std::move(gbuffer)), cache_dir_(std::move(cache_dir)),
      metallic_exponent_(metallic_exponent),
      without_scene_(scene.frame ? "a frame of another renderer has no triangles" : "")
{
}

/// All that is known without triangles.
SceneTruth Truths::only_reflecting(const TraceSettings& settings) const
{
    SceneTruth truth = empty_scene_truth(gbuffer_.view.size_px);
    for (size_t i = 0; i < truth.cls.size(); ++i)
        if (reflects(gbuffer_, pixel_at(i, truth.size_px), settings)) truth.cls[i] = TruthClass::hidden;
    return truth;
}

void Truths::make_scene_truth(const TraceSettings& settings)
{
    scene_truth_    = cached_scene_truth(cache_dir_, *scene_, gbuffer_, settings);
    depth_to_scene_ = compare_depth_to_scene(scene_truth_);
    without_scene_  = drawn_elsewhere(off_surface_share(scene_truth_));
    if (!without_scene_.empty()) scene_truth_ = only_reflecting(settings);
}

void Truths::make(const TraceSettings& settings, bool image_errors)
{
    if (made_for_ == settings) return;
    const bool keeps_scene_truth = made_for_ && same_scene_truth(*made_for_, settings);
    made_for_.reset();
    true_picture_.reset();
    screen_truth_.reset();
    if (without_screen(settings).empty()) screen_truth_ = cached_screen_truth(cache_dir_, gbuffer_, settings);
    if (scene_->frame) {
        scene_truth_ = only_reflecting(settings);
    } else if (!keeps_scene_truth) {
        reference_.reset();
        make_scene_truth(settings);
    }
    if (image_errors && !reference_ && without_scene_.empty()) reference_.emplace(reference_image(scene_truth_));
    made_for_ = settings;
}

const TraceSettings& Truths::made_for() const
{
    if (!made_for_) throw_failure("truths were asked for before they were made");
    return *made_for_;
}

const SceneTruth& Truths::scene_truth() const
{
    made_for();
    return scene_truth_;
}

std::optional<Image> Truths::agreement(const TraceImage& counted) const
{
    made_for();
    if (without_scene_.empty()) return agreement_picture(counted, scene_truth_);
    return screen_truth_ ? std::optional(agreement_picture(counted, *screen_truth_)) : std::nullopt;
}

std::optional<Image> Truths::causes(const TraceImage& counted) const
{
    made_for();
    return !without_scene_.empty() ? std::nullopt : std::optional(causes_picture(counted, scene_truth_, gbuffer_));
}

std::string Truths::without_screen(const TraceSettings& settings)
{
    if (has_screen_truth(settings.surface)) return "";
    return fmt::format("the surface model {} is known by its shaders alone", settings.surface);
}

std::optional<Image> Truths::given_picture() const
{
    if (!scene_->frame || scene_->frame->reference.empty()) return std::nullopt;
    const Image file = read_image(scene_->frame->reference);
    Image       image{file.size_px, {"R", "G", "B"}, std::vector<float>(pixel_count(file.size_px) * 3), {}};
    if (file.size_px != gbuffer_.view.size_px)
        throw_spec_error("{}: {}x{} pixels, expected {}x{} as the frame has", short_path(scene_->frame->reference),
                         file.size_px.x, file.size_px.y, gbuffer_.view.size_px.x, gbuffer_.view.size_px.y);
    for (size_t c = 0; c < 3; ++c) {
        const auto found = std::ranges::find_if(file.channels, [&](const std::string& name) {
            return name == image.channels[c] || name.ends_with("Combined." + image.channels[c]);
        });
        if (found == file.channels.end())
            throw_spec_error("{}: no channel '{}'; expected R, G and B", short_path(scene_->frame->reference),
                             image.channels[c]);
        const auto from = static_cast<size_t>(found - file.channels.begin());
        for (size_t i = 0; i < pixel_count(file.size_px); ++i)
            image.values[3 * i + c] = file.values[file.channels.size() * i + from];
    }
    return image;
}

const Image& Truths::true_picture()
{
    const TraceSettings& settings = made_for();
    if (!true_picture_) {
        glossy_ =
            cached_glossy_truth(cache_dir_, *scene_, gbuffer_, settings, {.metallic_exponent = metallic_exponent_});
        true_picture_ = ssrlab::true_picture(*glossy_, gbuffer_, scene_->ambient);
    }
    return *true_picture_;
}

Reference Truths::true_reference()
{
    const Image&     mean   = true_picture();
    const std::array halves = {ssrlab::true_picture(*glossy_, gbuffer_, scene_->ambient, 1),
                               ssrlab::true_picture(*glossy_, gbuffer_, scene_->ambient, -1)};
    return Reference(mean, halves);
}

void Truths::make_reprojection(const SceneInTime& before, const SceneInTime& earlier)
{
    const SceneBvh now(*scene_);
    const auto     truth_of = [&](const SceneInTime& then) {
        return then.motion.moving_draws == 0 ? reprojection_truth(now, now, gbuffer_, then.motion)
                                                 : reprojection_truth(now, SceneBvh(then.scene), gbuffer_, then.motion);
    };
    before_  = truth_of(before);
    earlier_ = truth_of(earlier);
}

MeasureValues Truths::compare_motion(const TraceImage& counted, std::span<const glm::vec2> found_px) const
{
    made_for();
    if (!before_ || gbuffer_.motion_px.empty()) return {};
    MeasureValues values = count_disocclusions(*before_);
    merge(values, compare_surface_motion(gbuffer_.motion_px, *before_, counted, scene_truth_));
    if (!found_px.empty()) merge(values, compare_reprojection(found_px, *before_, counted, scene_truth_));
    return values;
}

MeasureValues Truths::compare_ghosts(const Image& picture, const Reference& reference) const
{
    made_for();
    return earlier_ ? ssrlab::compare_ghosts(picture, reference, *earlier_, scene_truth_) : MeasureValues{};
}

MeasureValues Truths::compare_converged(const Image& picture, const Reference& converged) const
{
    made_for();
    return ssrlab::compare_converged(picture, converged, scene_truth_);
}

MeasureValues Truths::compare_picture(const Image& picture, const Reference& reference) const
{
    made_for();
    return compare_pictures(picture, reference, scene_truth_, gbuffer_);
}

Image Truths::flip_of(const Image& picture, const Reference& reference) const
{
    made_for();
    return flip_of_picture(picture, reference, scene_truth_);
}

MeasureValues Truths::compare(const TraceImage& counted, const TraceImage* twin, const TraceImage* hidden) const
{
    made_for();
    const TraceImage* screen = screen_truth_ ? &*screen_truth_ : nullptr;
    MeasureValues     values = split_error(counted, twin, screen, without_scene_.empty() ? &scene_truth_ : nullptr);
    if (screen != nullptr) merge(values, compare_to_screen_truth(counted, *screen));
    merge(values, depth_to_scene_);
    if (!without_scene_.empty()) return values;
    merge(values, compare_to_scene_truth(counted, scene_truth_, screen, gbuffer_));
    merge(values, count_causes(counted, scene_truth_, gbuffer_));
    if (hidden != nullptr) merge(values, compare_hidden_layer(counted, *hidden, scene_truth_));
    if (reference_)
        merge(values,
              compare_images(reflected_image(counted, gbuffer_, scene_->background), *reference_, scene_truth_));
    return values;
}

} // namespace ssrlab
