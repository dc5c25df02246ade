#include "compare/display.h"

#include "core/error.h"
#include "core/parallel_rows.h"
#include "core/pixel_index.h"

#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cmath>

namespace ssrlab {
namespace {

/// NaN gives 0: every comparison with it is false.
float     clamped(float value) { return value > 0 ? std::min(value, 1.0F) : 0; }
glm::vec3 clamped(glm::vec3 value) { return {clamped(value.x), clamped(value.y), clamped(value.z)}; }

float agx_contrast(float x)
{
    const float x2 = x * x, x4 = x2 * x2;
    return 15.5F * x4 * x2 - 40.14F * x4 * x + 31.96F * x4 - 6.868F * x2 * x + 0.4298F * x2 + 0.1191F * x - 0.00232F;
}

glm::vec3 agx(glm::vec3 radiance)
{
    constexpr float darkest_ev = -12.47393F, brightest_ev = 4.026069F;
    const glm::mat3 inset(0.842479062253094F, 0.0423282422610123F, 0.0423756549057051F, 0.0784335999999992F,
                          0.878468636469772F, 0.0784336F, 0.0792237451477643F, 0.0791661274605434F, 0.879142973793104F);
    const glm::mat3 outset(1.19687900512017F, -0.0528968517574562F, -0.0529716355144438F, -0.0980208811401368F,
                           1.15190312990417F, -0.0980434501171241F, -0.0990297440797205F, -0.0989611768448433F,
                           1.15107367264116F);
    // Infinite radiance times a matrix may be NaN; 2^16 lies beyond the brightest.
    glm::vec3 value = inset * glm::clamp(radiance, glm::vec3(0), glm::vec3(65536));
    for (int c : {0, 1, 2}) {
        const float ev = std::clamp(std::log2(std::max(value[c], 1e-10F)), darkest_ev, brightest_ev);
        value[c]       = agx_contrast((ev - darkest_ev) / (brightest_ev - darkest_ev));
    }
    return glm::pow(clamped(outset * value), glm::vec3(2.2F));
}

constexpr float label_grey = 0.7F;

} // namespace

Image to_display(const Image& radiance, const Display& display)
{
    Image       image    = radiance;
    const float exposure = std::exp2(static_cast<float>(display.exposure_ev));
    parallel_pixels(image.size_px.x, image.size_px.y, [&](size_t i) {
        float*          at    = &image.values[3 * i];
        const glm::vec3 value = exposure * glm::vec3(at[0], at[1], at[2]);
        const glm::vec3 shown =
            display.transform == Display::Transform::agx && value == value ? agx(value) : clamped(value);
        for (int c : {0, 1, 2}) at[c] = shown[c];
    });
    return image;
}

Image mean_of(Image sum, int count)
{
    for (float& value : sum.values) value /= static_cast<float>(count);
    return sum;
}

void add_to(Image& sum, const Image& image)
{
    if (sum.values.empty()) {
        sum = image;
        return;
    }
    if (sum.values.size() != image.values.size()) throw_failure("pictures to be added have different sizes");
    std::ranges::transform(sum.values, image.values, sum.values.begin(), std::plus());
}

Image side_by_side(std::span<const LabelledImage> pictures)
{
    namespace algo           = OIIO::ImageBufAlgo;
    const glm::ivec2 size_px = pictures.front().image.size_px;
    const int        count = static_cast<int>(pictures.size()), text_px = std::clamp(size_px.x / 20, 8, 32),
              strip_px = text_px * 3 / 2;
    Image all{{size_px.x * count, size_px.y + strip_px}, {"R", "G", "B"}, {}, pictures.front().image.metadata};
    all.values.resize(3 * pixel_count(all.size_px));
    OIIO::ImageBuf canvas(OIIO::ImageSpec(all.size_px.x, all.size_px.y, 3, OIIO::TypeDesc::FLOAT), all.values.data());
    for (int k = 0; k < count; ++k) {
        const LabelledImage& one = pictures[static_cast<size_t>(k)];
        if (one.image.size_px != size_px) throw_failure("pictures side by side have different sizes");
        OIIO::ImageBuf source(OIIO::ImageSpec(size_px.x, size_px.y, 3, OIIO::TypeDesc::FLOAT),
                              const_cast<float*>(one.image.values.data()));
        const bool     done =
            algo::paste(canvas, k * size_px.x, strip_px, 0, 0, source) &&
            algo::render_text(canvas, k * size_px.x + size_px.x / 2, strip_px / 2, one.label, text_px, "DejaVuSans",
                              {label_grey, label_grey, label_grey}, algo::TextAlignX::Center, algo::TextAlignY::Center);
        if (!done)
            throw_failure("the label '{}' cannot be written: {}; install fonts-dejavu-core", one.label,
                          canvas.geterror());
    }
    return all;
}

} // namespace ssrlab
