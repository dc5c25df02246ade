#include "export/answers.h"

#include "core/error.h"
#include "core/files.h"
#include "shared.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr size_t ray_words = 8, hit_words = 2; // README.md of an export says what they hold
constexpr size_t most_listed = 10;             // differing rays of a frame
constexpr double near_tie_px = 0.05;           // what rounding may move a hit

glm::ivec2 pixel_of(uint32_t word) { return {word & (MAX_IMAGE_PX - 1), (word >> PIXEL_BITS) & (MAX_IMAGE_PX - 1)}; }

/// "(x, y)" of a ray's or hit's word.
std::string pixel_text(uint32_t word) { return fmt::format("({}, {})", pixel_of(word).x, pixel_of(word).y); }

TraceStatus status_of(uint32_t word)
{
    return static_cast<TraceStatus>(number_to_status(static_cast<int>(word >> (2 * PIXEL_BITS))));
}

float real_of(uint32_t word) { return std::bit_cast<float>(word); }

std::string hit_text(const uint32_t* hit)
{
    const TraceStatus status = status_of(hit[0]);
    if (!has_place(status)) return std::string(status_name(status));
    return fmt::format("{} {} t {:.9g}", status_name(status), pixel_text(hit[0]), real_of(hit[1]));
}

/// Pixel and status in one word; t counts where there is a pixel.
bool same_hit(const uint32_t* a, const uint32_t* b)
{
    return a[0] == b[0] && (!has_place(status_of(a[0])) || a[1] == b[1]);
}

/// Between the points where two answers end a ray; infinite where they are not of one status with a place, or their pixels
/// do not touch.
double distance_px(const uint32_t* ray, const uint32_t* a, const uint32_t* b)
{
    const TraceStatus status = status_of(a[0]);
    const glm::ivec2  apart  = glm::abs(pixel_of(a[0]) - pixel_of(b[0]));
    if (status != status_of(b[0]) || !has_place(status) || std::max(apart.x, apart.y) > 1)
        return std::numeric_limits<double>::infinity();
    const double difference = static_cast<double>(real_of(a[1])) - static_cast<double>(real_of(b[1]));
    return std::abs(difference) * std::hypot(real_of(ray[4]), real_of(ray[5]));
}

std::string cause_text(double apart_px)
{
    return apart_px < near_tie_px ? fmt::format(" ({:.2g} px apart: rounding)", apart_px) : " (unexplained)";
}

void compare_hits(FrameVerdict& verdict, const Words& rays, const Words& expected, const Words& answered)
{
    verdict.rays = expected.size() / hit_words;
    if (answered.size() != expected.size()) throw_failure("{}: not every ray has an answer", verdict.frame);
    for (size_t i = 0; i < verdict.rays; ++i) {
        const uint32_t *right = &expected[i * hit_words], *given = &answered[i * hit_words];
        if (same_hit(right, given)) continue;
        const double apart_px = distance_px(&rays[i * ray_words], right, given);
        if (apart_px < near_tie_px) ++verdict.near_ties;
        if (verdict.differing++ >= most_listed) continue;
        verdict.listed.push_back(fmt::format("ray {} of pixel {}: {}, expected {}{}", i,
                                             pixel_text(rays[i * ray_words + 7]), hit_text(given), hit_text(right),
                                             cause_text(apart_px)));
    }
}

uint32_t pixel_word(const std::array<uint32_t, ray_words>& ray) { return ray[7] & ((1U << (2 * PIXEL_BITS)) - 1); }

/// Between the begins or the ends of two rays, whichever is more; infinite where one is not finite.
double distance_px(const std::array<uint32_t, ray_words>& a, const std::array<uint32_t, ray_words>& b)
{
    double most = 0;
    for (const size_t axis : {0U, 1U}) {
        const double begin = static_cast<double>(real_of(a[axis])) - static_cast<double>(real_of(b[axis]));
        const double along = static_cast<double>(real_of(a[axis + 4])) - static_cast<double>(real_of(b[axis + 4]));
        for (const double apart : {begin, begin + along})
            most = std::max(most, std::isfinite(apart) ? std::abs(apart) : std::numeric_limits<double>::infinity());
    }
    return most;
}

/// The ray set-up lists pixels in any order.
std::vector<std::array<uint32_t, ray_words>> by_pixel(const Words& words, size_t count)
{
    std::vector<std::array<uint32_t, ray_words>> rays(count);
    std::memcpy(rays.data(), words.data(), count * sizeof(rays[0]));
    std::ranges::sort(rays, {}, pixel_word);
    return rays;
}

/// Whether each ray of the frame is made. The set-up makes one at every pixel with a surface; a host asks the material, too.
void compare_set_up(FrameVerdict& verdict, const Words& rays, const Words& made, size_t count)
{
    verdict.set_up   = rays.size() / ray_words;
    const auto given = by_pixel(made, std::min(count, made.size() / ray_words));
    auto       next  = given.begin();
    for (const auto& ray : by_pixel(rays, verdict.set_up)) {
        while (next != given.end() && pixel_word(*next) < pixel_word(ray)) ++next;
        if (next != given.end() && *next == ray) continue;
        const bool   is_made  = next != given.end() && (*next)[7] == ray[7];
        const double apart_px = is_made ? distance_px(ray, *next) : std::numeric_limits<double>::infinity();
        if (apart_px < near_tie_px) ++verdict.near_ties;
        if (verdict.set_up_differing++ >= most_listed) continue;
        verdict.listed.push_back(
            fmt::format("the ray of pixel {} is set up otherwise{}", pixel_text(ray[7]), cause_text(apart_px)));
    }
}

} // namespace

Words read_words(const fs::path& path)
{
    const std::string bytes = read_file(path);
    Words             words(bytes.size() / sizeof(uint32_t));
    std::memcpy(words.data(), bytes.data(), words.size() * sizeof(uint32_t));
    return words;
}

void for_each_frame(const fs::path& folder, const std::function<void(const fs::path&)>& visit)
{
    std::vector<fs::path> files;
    if (fs::is_directory(folder / "frames"))
        for (const auto& entry : fs::directory_iterator(folder / "frames"))
            if (entry.path().extension() == ".json") files.push_back(entry.path());
    if (files.empty()) throw_spec_error("{}: no export: it has no frames/*.json", folder.string());
    std::ranges::sort(files);
    for (const fs::path& file : files) {
        try {
            visit(file);
        } catch (const json::exception& error) {
            throw_spec_error("{}: {}", file.string(), error.what());
        } catch (const std::out_of_range&) {
            throw_spec_error("{}: names a resource that it does not list", file.string());
        }
    }
}

FrameVerdict compare_answers(const json& frame, const fs::path& file, const Answers& answers)
{
    const fs::path frames = file.parent_path(), folder = frames.parent_path();
    const json&    expected  = frame.at("expected");
    const json&    resources = frame.at("resources");
    FrameVerdict   verdict{.frame = file.stem().string()};
    compare_hits(verdict, read_words(frames / resources.at("rays").at("file").get<std::string>()),
                 read_words(folder / "expected" / expected.at("hits").get<std::string>()), answers.hits);
    if (expected.contains("made_rays"))
        compare_set_up(verdict, read_words(frames / expected.at("made_rays").get<std::string>()), answers.made_rays,
                       answers.made_count);
    return verdict;
}

} // namespace ssrlab
