// Animations of glTF nodes, baked into one matrix for each frame. All animations of a file play at once from frame 0 on.
#include "scene/gltf.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace ssrlab::gltf {
namespace {

// Poses are matrices of 128 bytes; a file beyond this is a mistake or an attack.
constexpr double max_frames_of_file = 36'000;

bool all_finite(const std::vector<float>& values)
{
    return std::ranges::all_of(values, [](float value) { return std::isfinite(value); });
}

std::vector<float> read_times(const Import& import, int accessor, const std::string& where)
{
    std::vector<float> times_s = read_floats(import, accessor, 1, where);
    if (!all_finite(times_s) || times_s.front() < 0) import.fail("{}/input: a time is negative or not finite", where);
    const auto later = std::ranges::adjacent_find(times_s, std::greater_equal<>());
    if (later != times_s.end())
        import.fail("{}/input: times must increase, got {} s after {} s", where, *(later + 1), *later);
    if (times_s.back() * gltf_frames_per_second > max_frames_of_file)
        import.fail("{}/input: ends at {} s, at most {} s can be loaded", where, times_s.back(),
                    max_frames_of_file / gltf_frames_per_second);
    return times_s;
}

const tinygltf::AnimationSampler& sampler_of(const Import& import, const tinygltf::Animation& animation,
                                             int sampler_index, const std::string& where)
{
    if (sampler_index < 0 || static_cast<size_t>(sampler_index) >= animation.samplers.size())
        import.fail("{}: there is no sampler {}", where, sampler_index);
    return animation.samplers[static_cast<size_t>(sampler_index)];
}

Track read_track(const Import& import, const tinygltf::Animation& animation, int sampler_index, int components,
                 const std::string& where)
{
    const tinygltf::AnimationSampler& sampler = sampler_of(import, animation, sampler_index, where);
    const std::string                 place   = fmt::format("{}/samplers/{}", where, sampler_index);
    Track                             track;
    track.components = components;
    if (sampler.interpolation == "STEP")
        track.interpolation = Interpolation::step;
    else if (sampler.interpolation == "CUBICSPLINE")
        track.interpolation = Interpolation::cubic;
    else if (sampler.interpolation != "LINEAR" && !sampler.interpolation.empty())
        import.fail("{}/interpolation: expected LINEAR, STEP or CUBICSPLINE, got '{}'", place, sampler.interpolation);
    track.times_s      = read_times(import, sampler.input, place);
    track.values       = read_floats(import, sampler.output, components, place + "/output");
    const size_t rows  = track.times_s.size() * (track.interpolation == Interpolation::cubic ? 3 : 1);
    const size_t found = track.values.size() / static_cast<size_t>(components);
    if (found != rows) import.fail("{}/output: expected {} values for the times, got {}", place, rows, found);
    if (!all_finite(track.values)) import.fail("{}/output: a value is not finite", place);
    return track;
}

std::optional<Track>* property_of(NodeTracks& tracks, const std::string& path)
{
    if (path == "translation") return &tracks.translation;
    if (path == "rotation") return &tracks.rotation;
    if (path == "scale") return &tracks.scale;
    return nullptr;
}

/// No time is negative, so that frame 0 has the values of the first key. A key of cubic ones is three values long.
void read_first_weights(Import& import, const tinygltf::Animation& animation, const tinygltf::AnimationChannel& channel,
                        const std::string& where)
{
    const tinygltf::AnimationSampler& sampler = sampler_of(import, animation, channel.sampler, where);
    const std::string                 place   = fmt::format("{}/samplers/{}", where, channel.sampler);
    const size_t                      keys    = read_times(import, sampler.input, place).size();
    const std::vector<float>          values  = read_floats(import, sampler.output, 1, place + "/output");
    const size_t                      parts   = sampler.interpolation == "CUBICSPLINE" ? 3 : 1;
    const size_t                      targets = values.size() / keys / parts;
    if (targets * keys * parts != values.size())
        import.fail("{}/output: {} values cannot be shared among {} keys", place, values.size(), keys);
    if (!all_finite(values)) import.fail("{}/output: a value is not finite", place);
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(parts / 2 * targets);
    import.first_weights.try_emplace(channel.target_node, first, first + static_cast<std::ptrdiff_t>(targets));
    if (keys > 1) import.warn("animated morph targets are not supported: they stay as in frame 0");
}

void read_channel(Import& import, const tinygltf::Animation& animation, const tinygltf::AnimationChannel& channel,
                  const std::string& where)
{
    if (channel.target_path == "pointer")
        return import.warn("animations by KHR_animation_pointer are not supported: what they move stands still");
    const int node = channel.target_node;
    if (node < 0 || static_cast<size_t>(node) >= import.json.nodes.size())
        import.fail("{}/target: there is no node {}", where, node);
    if (channel.target_path == "weights") return read_first_weights(import, animation, channel, where);
    std::optional<Track>* property = property_of(import.tracks[node], channel.target_path);
    if (property == nullptr)
        import.fail("{}/target/path: expected translation, rotation, scale or weights, got '{}'", where,
                    channel.target_path);
    if (!import.json.nodes[static_cast<size_t>(node)].matrix.empty())
        import.fail("{}: node {} is animated, but has a matrix instead of translation, rotation and scale", where,
                    node);
    const int   components = channel.target_path == "rotation" ? 4 : 3;
    const Track track      = read_track(import, animation, channel.sampler, components, where);
    if (property->has_value())
        return import.warn(
            fmt::format("node {}: two animations of its {}; the first one is played", node, channel.target_path));
    import.frames =
        std::max(import.frames, 1 + static_cast<int>(std::ceil(track.times_s.back() * gltf_frames_per_second - 1e-3)));
    *property = track;
}

glm::dvec4 row(const Track& track, size_t index)
{
    glm::dvec4 value(0);
    for (int c = 0; c < track.components; ++c)
        value[c] = track.values[index * static_cast<size_t>(track.components) + static_cast<size_t>(c)];
    return value;
}

/// Along the shorter of the two arcs.
glm::dvec4 turned(glm::dvec4 from, glm::dvec4 to, double share)
{
    const auto quaternion = [](glm::dvec4 v) { return glm::normalize(glm::dquat(v.w, v.x, v.y, v.z)); };
    const auto q          = glm::slerp(quaternion(from), quaternion(to), share);
    return {q.x, q.y, q.z, q.w};
}

} // namespace

void read_animations(Import& import)
{
    for (size_t a = 0; a < import.json.animations.size(); ++a) {
        const tinygltf::Animation& animation = import.json.animations[a];
        const std::string          where     = fmt::format("/animations/{}", a);
        for (const tinygltf::AnimationChannel& channel : animation.channels)
            read_channel(import, animation, channel, where);
    }
    std::erase_if(import.tracks, [](const auto& entry) {
        const NodeTracks& tracks = entry.second;
        return !tracks.translation && !tracks.rotation && !tracks.scale;
    });
}

/// glTF 2.0, appendix C: before the first and after the last key a property keeps that key's value.
glm::dvec4 value_at(const Track& track, double time_s)
{
    const auto   stride = static_cast<size_t>(track.interpolation == Interpolation::cubic ? 3 : 1);
    const size_t middle = stride / 2, last = track.times_s.size() - 1;
    const auto   after = std::ranges::upper_bound(track.times_s, static_cast<float>(time_s));
    const auto   k     = static_cast<size_t>(after - track.times_s.begin());
    if (k == 0) return row(track, middle);
    if (k > last) return row(track, last * stride + middle);
    const glm::dvec4 from = row(track, (k - 1) * stride + middle), to = row(track, k * stride + middle);
    if (track.interpolation == Interpolation::step) return from;
    const double span_s = double(track.times_s[k]) - track.times_s[k - 1];
    const double t      = std::clamp((time_s - track.times_s[k - 1]) / span_s, 0.0, 1.0);
    if (track.interpolation == Interpolation::linear)
        return track.components == 4 ? turned(from, to, t) : glm::mix(from, to, t);
    const glm::dvec4 leaving = span_s * row(track, (k - 1) * stride + 2), arriving = span_s * row(track, k * stride);
    const double     t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * from + (t3 - 2 * t2 + t) * leaving + (3 * t2 - 2 * t3) * to + (t3 - t2) * arriving;
}

} // namespace ssrlab::gltf
