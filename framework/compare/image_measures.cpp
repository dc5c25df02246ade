// Measures that compare pictures with pictures.
#include "compare/measures.h"
#include "compare/pictures.h"
#include "core/error.h"
#include "core/parallel_rows.h"
#include "core/pixel_index.h"

#include <algorithm>
#include <cmath>

namespace ssrlab {
namespace {

/// Where belongs(index) holds.
template <typename Belongs> Mask make_mask(glm::ivec2 size_px, const Belongs& belongs)
{
    Mask mask(pixel_count(size_px));
    parallel_pixels(size_px.x, size_px.y, [&](size_t i) { mask[i] = belongs(i) ? 1 : 0; });
    return mask;
}

/// Outside the mask it stays linear.
Image to_display(const Image& linear, const Mask& mask)
{
    require_three_channels(linear);
    Image display = linear;
    parallel_pixels(linear.size_px.x, linear.size_px.y, [&](size_t i) {
        if (!is_inside(mask, i)) return;
        for (size_t c = 0; c < 3; ++c) display.values[3 * i + c] = linear_to_srgb(linear.values[3 * i + c]);
    });
    return display;
}

/// Rec. 709. Outside the mask `luma` stays as it is.
Plane to_luma(const Image& display, Plane luma, const Mask& mask)
{
    parallel_pixels(display.size_px.x, display.size_px.y, [&](size_t i) {
        if (!is_inside(mask, i)) return;
        const float* rgb = &display.values[3 * i];
        luma.values[i]   = 0.2126F * rgb[0] + 0.7152F * rgb[1] + 0.0722F * rgb[2];
    });
    return luma;
}

double mean_inside(const std::vector<float>& values, const Mask& mask)
{
    double sum = 0, count = 0;
    for (size_t i = 0; i < values.size(); ++i) {
        if (mask[i] == 0) continue;
        sum += double(values[i]);
        count += 1;
    }
    return sum / count;
}

/// A root mean square over all three channels, without the noise of the reference.
struct Rmse {
    std::optional<double> value;
    double                noise = 0, low = 0, high = 0; // that was taken off; 95 % interval that it leaves
};

/// Expected: (tested - reference)² = (tested - truth)² + noise. Where d² is that difference and n the noise of a pixel, chance moves d²
/// by 4 d² n + 2 n² (variance of a normal variable's square); pixels are independent.
Rmse rmse_inside(const Image& tested, const Reference& reference, const Mask& mask)
{
    double squares = 0, noise = 0, variance = 0, count = 0;
    for (size_t i = 0; i < mask.size(); ++i) {
        if (mask[i] == 0) continue;
        double square = 0;
        for (size_t c = 0; c < 3; ++c) {
            const double off = double(tested.values[3 * i + c]) - double(reference.display.values[3 * i + c]);
            square += off * off;
        }
        squares += square;
        count += 3;
        if (reference.noise.empty()) continue;
        const auto own = double(reference.noise[i]);
        noise += own;
        variance += 4 * square * own + 2 * own * own;
    }
    if (count == 0) return {};
    const double square = (squares - noise) / count, spread = 1.96 * std::sqrt(variance) / count;
    const auto   root = [](double value) { return std::sqrt(std::max(value, 0.0)); };
    return {root(square), root(noise / count), root(square - spread), root(square + spread)};
}

struct ImageErrors {
    Rmse                  rmse;
    std::optional<double> psnr_db, ssim, flip;
};

ImageErrors compare_inside(const Image& tested, const Reference& reference, const Mask& mask)
{
    ImageErrors errors;
    errors.rmse = rmse_inside(tested, reference, mask);
    if (!errors.rmse.value) return errors;
    if (*errors.rmse.value > 0) errors.psnr_db = -20 * std::log10(*errors.rmse.value);
    // The windows of SSIM and FLIP reach outside the mask, where nothing is to be judged: there both show the reference.
    const SsimView ssim = ssim_view(to_luma(tested, reference.ssim.luma, mask));
    const FlipView flip = flip_view_inside(tested, reference.flip, mask);
    errors.ssim         = mean_inside(ssim_map(ssim, reference.ssim, mask), mask);
    errors.flip         = mean_inside(flip_error(flip, reference.flip, mask), mask);
    return errors;
}

void require_comparable(const Image& image, const SceneTruth& truth)
{
    if (image.size_px != truth.size_px || image.values.size() != 3 * truth.cls.size()) {
        throw_failure("an image of {}x{} with {} values cannot be compared over {}x{} pixels with three channels",
                      image.size_px.x, image.size_px.y, image.values.size(), truth.size_px.x, truth.size_px.y);
    }
}

Mask visible_pixels(const SceneTruth& truth)
{
    return make_mask(truth.size_px, [&](size_t i) { return truth.cls[i] == TruthClass::visible; });
}

Mask reflective_pixels(const SceneTruth& truth)
{
    return make_mask(truth.size_px, [&](size_t i) { return truth.cls[i] != TruthClass::not_traced; });
}

/// Pixels with a surface of another material within 2 px.
bool at_material_border(const GBufferImage& gbuffer, glm::ivec2 pixel)
{
    constexpr int    reach_px = 2;
    constexpr float  step     = 0.1F;
    const glm::ivec2 size     = gbuffer.view.size_px;
    const auto       index    = [&](int x, int y) { return pixel_index({x, y}, size); };
    const size_t     own      = index(pixel.x, pixel.y);
    for (int y = std::max(0, pixel.y - reach_px); y <= std::min(size.y - 1, pixel.y + reach_px); ++y)
        for (int x = std::max(0, pixel.x - reach_px); x <= std::min(size.x - 1, pixel.x + reach_px); ++x) {
            const size_t other = index(x, y);
            if (gbuffer.depth[other] > 0 && (std::abs(gbuffer.metallic[other] - gbuffer.metallic[own]) > step ||
                                             std::abs(gbuffer.roughness[other] - gbuffer.roughness[own]) > step))
                return true;
        }
    return false;
}

} // namespace

Reference::Reference(const Image& linear_radiance, std::span<const Image> halves)
    : display(to_display(linear_radiance, {})),
      ssim(ssim_view(to_luma(display, {display.size_px, std::vector<float>(display.values.size() / 3)}, {}))),
      flip(flip_view(display))
{
    if (halves.size() != 2) return;
    const Image even = to_display(halves[0], {}), odd = to_display(halves[1], {});
    noise.resize(pixel_count(display.size_px));
    for (size_t v = 0; v < even.values.size(); ++v) {
        const float off = (even.values[v] - odd.values[v]) / 2;
        noise[v / 3] += off * off;
    }
}

Image reference_image(const SceneTruth& truth)
{
    Image image;
    image.size_px  = truth.size_px;
    image.channels = {"R", "G", "B"};
    for (size_t i = 0; i < truth.cls.size(); ++i) {
        const glm::vec3 radiance = truth.cls[i] == TruthClass::not_traced ? glm::vec3(0) : truth.radiance[i];
        image.values.insert(image.values.end(), {radiance.r, radiance.g, radiance.b});
    }
    return image;
}

MeasureValues compare_images(const Image& tested, const Reference& reference, const SceneTruth& truth)
{
    require_comparable(tested, truth);
    require_comparable(reference.display, truth);
    const Mask        reflective      = reflective_pixels(truth);
    const Image       display         = to_display(tested, reflective);
    const ImageErrors over_visible    = compare_inside(display, reference, visible_pixels(truth));
    const ImageErrors over_reflective = compare_inside(display, reference, reflective);
    return {{"rmse_visible", over_visible.rmse.value},
            {"psnr_visible_db", over_visible.psnr_db},
            {"ssim_visible", over_visible.ssim},
            {"flip_visible", over_visible.flip},
            {"rmse_reflective", over_reflective.rmse.value},
            {"psnr_reflective_db", over_reflective.psnr_db},
            {"ssim_reflective", over_reflective.ssim},
            {"flip_reflective", over_reflective.flip}};
}

MeasureValues count_not_finite(const Image& picture, const GBufferImage* gbuffer)
{
    const size_t pixels = pixel_count(picture.size_px), channels = picture.channels.size();
    const auto   bad        = [](float value) { return !std::isfinite(value); };
    const auto   bad_colour = [&](glm::vec3 value) { return bad(value.x) || bad(value.y) || bad(value.z); };
    size_t       count      = 0;
    for (size_t i = 0; i < pixels; ++i) {
        bool found = false;
        for (size_t c = 0; c < channels; ++c) found = found || bad(picture.values[i * channels + c]);
        if (gbuffer != nullptr) {
            for (const std::vector<float>* plane :
                 {&gbuffer->depth, &gbuffer->roughness, &gbuffer->metallic, &gbuffer->diffuse_share})
                found = found || (i < plane->size() && bad((*plane)[i]));
            for (const std::vector<glm::vec3>* plane : {&gbuffer->normal_vs, &gbuffer->base_colour, &gbuffer->radiance,
                                                        &gbuffer->highlight, &gbuffer->emission})
                found = found || (i < plane->size() && bad_colour((*plane)[i]));
        }
        count += found;
    }
    return {{"not_finite", double(count)}};
}

MeasureValues compare_pictures(const Image& tested, const Reference& reference, const SceneTruth& truth,
                               const GBufferImage& gbuffer)
{
    require_comparable(tested, truth);
    require_comparable(reference.display, truth);
    const Mask  reflective = reflective_pixels(truth), visible = visible_pixels(truth);
    const Mask  border         = make_mask(truth.size_px, [&](size_t i) {
        return reflective[i] != 0 && at_material_border(gbuffer, pixel_at(i, truth.size_px));
    });
    const Mask  visible_border = make_mask(truth.size_px, [&](size_t i) { return visible[i] != 0 && border[i] != 0; });
    const Image display        = to_display(tested, reflective);
    const ImageErrors errors   = compare_inside(display, reference, reflective);
    const auto        rmse     = [&](const Mask& mask) { return rmse_inside(display, reference, mask).value; };
    const auto        known    = [&](double value) { return errors.rmse.value ? std::optional(value) : std::nullopt; };
    return {{"picture_rmse", errors.rmse.value},
            {"picture_rmse_low", known(errors.rmse.low)},
            {"picture_rmse_high", known(errors.rmse.high)},
            {"picture_noise_rmse", known(errors.rmse.noise)},
            {"picture_psnr_db", errors.psnr_db},
            {"picture_ssim", errors.ssim},
            {"picture_flip", errors.flip},
            {"picture_border_rmse", rmse(border)},
            {"picture_visible_rmse", rmse(visible)},
            {"picture_visible_border_rmse", rmse(visible_border)}};
}

MeasureValues compare_ghosts(const Image& tested, const Reference& reference, const ReprojectionTruth& earlier,
                             const SceneTruth& truth)
{
    require_comparable(tested, truth);
    require_comparable(reference.display, truth);
    require_same_size(earlier.size_px, truth.size_px);
    const Mask behind_edges = make_mask(truth.size_px, [&](size_t i) {
        return truth.cls[i] == TruthClass::visible && earlier.cls[i] == ReprojectionClass::hidden;
    });
    return {{"ghosting_rmse", rmse_inside(to_display(tested, behind_edges), reference, behind_edges).value}};
}

MeasureValues compare_converged(const Image& tested, const Reference& converged, const SceneTruth& truth)
{
    require_comparable(tested, truth);
    require_comparable(converged.display, truth);
    const Mask reflective = reflective_pixels(truth);
    return {{"converged_rmse", rmse_inside(to_display(tested, reflective), converged, reflective).value}};
}

Image flip_of_picture(const Image& tested, const Reference& reference, const SceneTruth& truth)
{
    require_comparable(tested, truth);
    require_comparable(reference.display, truth);
    const Mask     reflective = reflective_pixels(truth);
    const FlipView flip       = flip_view_inside(to_display(tested, reflective), reference.flip, reflective);
    return flip_picture(tested.size_px, flip_error(flip, reference.flip, reflective), reflective);
}

} // namespace ssrlab
