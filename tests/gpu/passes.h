// Single passes on reflections made by hand.
#pragma once

#include "frame/frame_inputs.h"
#include "gpu/device.h"
#include "unit/truth_gbuffers.h"

#include <glm/gtc/packing.hpp>

namespace ssrlab::test {

/// A reflection's colour and weight, pixel by pixel.
using Reflection = std::vector<glm::vec4>;
inline constexpr glm::vec4 nothing_reflects{0, 0, 0, -1};

/// Of 64 x 64 pixels: the left half must be the same to the last bit; how many pixels of the right half differ.
inline size_t changes_on_the_right_alone(const Reflection& found, const Reflection& before)
{
    size_t changed = 0;
    for (size_t i = 0; i < 64 * 64; ++i) {
        const size_t x = i % 64;
        if (x < 32)
            EXPECT_EQ(found[i], before[i]) << x << ", " << i / 64;
        else
            changed += found[i] != before[i];
    }
    return changed;
}

inline FramePtr frame_with(const Picture& picture, const ParameterValues& passes,
                           const std::string& technique_id = "dda", const std::string& surface = "box")
{
    FrameSettings settings;
    settings.trace = {.thickness_m = 0.5, .max_distance_m = 50, .behind = Behind::hit, .surface = surface};
    for (const auto& [name, value] : passes) settings.passes.at(name) = value;
    const Technique& chosen = technique(technique_id);
    return prepared_frame(picture.buffers, chosen, values_of(chosen), settings);
}

inline void set_reflection(const Picture& picture, const Reflection& reflection)
{
    std::vector<uint64_t> texels;
    for (const glm::vec4& value : reflection) texels.push_back(glm::packHalf4x16(value));
    upload(device(), picture.buffers->reflection, texels.data(), texels.size() * sizeof(uint64_t));
}

inline Reflection read_colours(const GpuImage& image)
{
    Reflection colours;
    for (const uint64_t texel : download_as<uint64_t>(device(), image)) colours.push_back(glm::unpackHalf4x16(texel));
    return colours;
}

/// Runs these passes and nothing else.
inline void run_passes(ReadyFrame& frame, const std::vector<Pass>& passes)
{
    std::vector<RecordFunction> record_functions;
    for (const Pass& pass : passes) record_functions.push_back(pass.prepare(device(), {frame.inputs, pass, pass.id}));
    submit(device(), [&](const Commands& commands) {
        barrier(commands);
        for (const RecordFunction& record : record_functions) {
            record(commands);
            barrier(commands);
        }
    });
}

/// Lists the tiles, then runs the pass.
inline void run_pass(ReadyFrame& frame, const Pass& pass) { run_passes(frame, {classification_pass(), pass}); }

/// A wall of metal that fills the picture and faces the camera.
inline GBufferImage metal_wall(glm::ivec2 size_px, double distance_m = 5)
{
    GBufferImage image = empty_gbuffer(bench_view(size_px));
    for (const auto [i, x, y] : pixels_of(size_px)) {
        set_pixel(image, x, y, distance_m, {0, 0, 1}, 1);
        image.base_colour[i] = glm::vec3(1);
    }
    return image;
}

} // namespace ssrlab::test
