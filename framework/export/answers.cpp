#include "export/answers.h"

#include "core/error.h"
#include "core/files.h"
#include "core/pixel_index.h"
#include "shared.h"
#include "trace/depth_buffer.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <optional>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr size_t ray_words = 8, hit_words = 2; // README.md of an export says what they hold
constexpr double near_tie_px = 0.05;           // what rounding may move a hit
constexpr double near_tie    = 1e-5;           // and, of its size, the depth or length of a ray that is set up

glm::ivec2 pixel_of(uint32_t word) { return {word & (MAX_IMAGE_PX - 1), (word >> PIXEL_BITS) & (MAX_IMAGE_PX - 1)}; }

TraceStatus status_of(uint32_t word)
{
    return static_cast<TraceStatus>(number_to_status(static_cast<int>(word >> (2 * PIXEL_BITS))));
}

float real_of(uint32_t word) { return std::bit_cast<float>(word); }

std::string hit_text(const uint32_t* hit)
{
    const TraceStatus status = status_of(hit[0]);
    if (!has_place(status)) return std::string(status_name(status));
    const glm::ivec2 pixel = pixel_of(hit[0]);
    return fmt::format("{} ({}, {}) t {:.9g}", status_name(status), pixel.x, pixel.y, real_of(hit[1]));
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

void add_word(std::string& text, const std::string& word) { text += (text.empty() ? "" : " ") + word; }

/// What differs between two hits.
std::string values_of(const uint32_t* a, const uint32_t* b)
{
    if (status_of(a[0]) != status_of(b[0])) return "status";
    std::string values;
    if (a[0] != b[0]) add_word(values, "pixel");
    if (a[1] != b[1]) add_word(values, "t");
    return values;
}

void compare_hits(FrameVerdict& verdict, const Words& rays, const Words& expected, const Words& answered)
{
    verdict.rays = expected.size() / hit_words;
    if (answered.size() != expected.size()) throw_failure("{}: not every ray has an answer", verdict.frame);
    for (size_t i = 0; i < verdict.rays; ++i) {
        const uint32_t *right = &expected[i * hit_words], *given = &answered[i * hit_words];
        if (same_hit(right, given)) continue;
        const double apart_px = distance_px(&rays[i * ray_words], right, given);
        verdict.differences.push_back({false, i, pixel_of(rays[i * ray_words + 7]), values_of(right, given),
                                       hit_text(right), hit_text(given), apart_px, apart_px < near_tie_px});
    }
}

using RayWords = std::array<uint32_t, ray_words>;

uint32_t pixel_word(const RayWords& ray) { return ray[7] & ((1U << (2 * PIXEL_BITS)) - 1); }

/// Between the begins or the ends of two rays, whichever is more; infinite where one is not finite.
double distance_px(const RayWords& a, const RayWords& b)
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

/// Depths are of the size of the larger of a ray's ends.
bool is_near(const RayWords& a, const RayWords& b)
{
    const auto apart  = [&](size_t i) { return std::abs(real_of(a[i]) - real_of(b[i])); };
    const auto bound  = [](float size) { return static_cast<float>(near_tie) * std::abs(size); };
    const auto depths = std::max(std::abs(real_of(a[2])), std::abs(real_of(a[2]) + real_of(a[6])));
    return a[7] == b[7] && distance_px(a, b) < near_tie_px && apart(3) <= bound(real_of(a[3])) &&
           apart(2) <= bound(depths) && apart(6) <= bound(depths);
}

AnswerDifference set_up_difference(const RayWords& right, const RayWords* made)
{
    static constexpr std::array<const char*, ray_words> names{"x_px",       "y_px",       "depth",       "length_m",
                                                              "delta_x_px", "delta_y_px", "delta_depth", "end"};
    AnswerDifference                                    found{.is_set_up = true, .pixel = pixel_of(right[7])};
    found.apart_px = std::numeric_limits<double>::infinity();
    if (made == nullptr) {
        found.values   = "ray";
        found.expected = "made";
        found.answered = "none";
        return found;
    }
    const auto text = [](size_t i, uint32_t word) {
        return i == 7 ? std::string(status_name(status_of(word))) : fmt::format("{:.9g}", real_of(word));
    };
    for (size_t i = 0; i < ray_words; ++i) {
        if (right[i] == (*made)[i]) continue;
        add_word(found.values, names[i]);
        add_word(found.expected, text(i, right[i]));
        add_word(found.answered, text(i, (*made)[i]));
    }
    found.apart_px    = distance_px(right, *made);
    found.is_near_tie = is_near(right, *made);
    return found;
}

/// The ray set-up lists pixels in any order.
std::vector<RayWords> by_pixel(const Words& words, size_t count)
{
    std::vector<RayWords> rays(count);
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
    for (const RayWords& ray : by_pixel(rays, verdict.set_up)) {
        while (next != given.end() && pixel_word(*next) < pixel_word(ray)) ++next;
        const bool is_made = next != given.end() && pixel_word(*next) == pixel_word(ray);
        if (!is_made || *next != ray) verdict.differences.push_back(set_up_difference(ray, is_made ? &*next : nullptr));
    }
}

/// What README.md of an export says of a resource; nullopt for one of a structure.
std::optional<size_t> bytes_needed(const std::string& name, glm::ivec2 size_px, size_t rays)
{
    const size_t                        pixels = pixel_count(size_px);
    const std::map<std::string, size_t> needed{{"view", 48},
                                               {"host_depth", 4 * pixels},
                                               {"host_gradients", 4 * pixels},
                                               {"cells", depth_buffer_bytes(size_px)},
                                               {"normals", 16 * pixels},
                                               {"solids", 4 * pixels},
                                               {"ray_count", 4},
                                               {"rays", ray_words * 4 * rays},
                                               {"hits", hit_words * 4 * std::max<size_t>(rays, 1)},
                                               {"made_count", 4},
                                               {"made_rays", ray_words * 4 * pixels}};
    const auto                          found = needed.find(name);
    return found == needed.end() ? std::nullopt : std::optional(found->second);
}

void require_bytes(const fs::path& file, size_t expected)
{
    std::error_code error;
    const auto      bytes = fs::file_size(file, error);
    if (error) throw_spec_error("{}: {}", short_path(file), error.message());
    if (bytes != expected) throw_spec_error("{}: {} bytes, expected {}", short_path(file), bytes, expected);
}

} // namespace

void require_sizes(const json& frame, const fs::path& file)
{
    const fs::path   frames = file.parent_path(), folder = frames.parent_path();
    const glm::ivec2 size_px(frame.at("size_px").at(0), frame.at("size_px").at(1));
    const auto       rays = frame.at("rays").get<size_t>();
    if (std::min(size_px.x, size_px.y) < 1 || std::max(size_px.x, size_px.y) > MAX_IMAGE_PX)
        throw_spec_error("{}: an image of {} x {} pixels, expected 1 to {}", short_path(file), size_px.x, size_px.y,
                         MAX_IMAGE_PX);
    for (const auto& [name, resource] : frame.at("resources").items()) {
        const auto bytes  = resource.at("bytes").get<size_t>(),
                   needed = bytes_needed(name, size_px, rays).value_or(bytes);
        if (bytes != needed)
            throw_spec_error("{}: {} bytes of '{}', expected {}", short_path(file), bytes, name, needed);
        if (resource.contains("file")) require_bytes(frames / resource.at("file").get<std::string>(), bytes);
    }
    const json& expected = frame.at("expected");
    require_bytes(folder / "expected" / expected.at("hits").get<std::string>(), hit_words * 4 * rays);
    if (expected.contains("made_rays"))
        require_bytes(frames / expected.at("made_rays").get<std::string>(), ray_words * 4 * rays);
}

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
