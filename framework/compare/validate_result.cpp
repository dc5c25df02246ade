#include "compare/validate_result.h"

#include <algorithm>
#include <cmath>

namespace ssrlab {
namespace {

size_t ray_count(const TraceImage& result)
{
    return static_cast<size_t>(
        std::ranges::count_if(result.status, [](TraceStatus status) { return status != TraceStatus::not_traced; }));
}

std::string off_the_image(glm::ivec2 pixel, glm::ivec2 size_px)
{
    return fmt::format("hit pixel ({}, {}) is off the image of {}x{}", pixel.x, pixel.y, size_px.x, size_px.y);
}

Answer answer_at(const TraceImage& result, size_t i)
{
    return {result.status[i], result.hit_pixel[i], result.hit_t[i], result.steps[i]};
}

} // namespace

std::string impossible(const Answer& answer, glm::ivec2 size_px, double most_steps)
{
    if (static_cast<size_t>(answer.status) >= trace_status_names.size()) {
        const auto status = static_cast<int32_t>(answer.steps);
        if (status == static_cast<int>(TraceStatus::hit)) return off_the_image(answer.hit_pixel, size_px);
        return fmt::format("status {} is none of 1 … {}", status, trace_status_names.size() - 1);
    }
    if (answer.steps > most_steps)
        return fmt::format("{} steps, but the technique declares at most {}", answer.steps, most_steps);
    if (!has_place(answer.status)) return "";
    const glm::ivec2 pixel = answer.hit_pixel;
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= size_px.x || pixel.y >= size_px.y)
        return off_the_image(pixel, size_px);
    if (std::isnan(answer.t)) return "t of a hit is not a number";
    if (answer.t < 0 || answer.t > 1) return fmt::format("t = {} of a hit is outside [0, 1]", answer.t);
    return "";
}

std::optional<std::string> find_impossible(const TraceImage& result, double most_steps)
{
    size_t      count = 0;
    std::string first;
    for (size_t i = 0; i < result.status.size(); ++i) {
        if (result.status[i] == TraceStatus::not_traced) continue;
        const std::string what = impossible(answer_at(result, i), result.size_px, most_steps);
        if (what.empty() || count++ > 0) continue;
        const glm::ivec2 pixel = pixel_at(i, result.size_px);
        first                  = fmt::format("the first is the ray of pixel ({}, {}): {}", pixel.x, pixel.y, what);
    }
    if (count == 0) return std::nullopt;
    return fmt::format("{} of {} rays have an answer that cannot be; {}", count, ray_count(result), first);
}

void require_possible(const TraceImage& result, double most_steps)
{
    if (const auto found = find_impossible(result, most_steps)) throw InvalidResult(*found);
}

} // namespace ssrlab
