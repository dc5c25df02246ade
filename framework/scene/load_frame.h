// Frame files: an EXR of another renderer, and a small file that says what its numbers mean.
#pragma once

#include "core/gbuffer_image.h"
#include "core/image.h"

#include <filesystem>
#include <string>
#include <vector>

namespace ssrlab {

struct Frame {
    GBufferImage             gbuffer;
    std::filesystem::path    reference; // a picture of the true reflections, or empty
    std::vector<std::string> warnings;  // one line each
};

/// Loads a frame file (docs/reference/frame_files.md). Throws SpecError for what the user can fix, Failure for a
/// damaged file; the message names file and channel, what was expected and what was found.
Frame load_frame(const std::filesystem::path& exr);

/// Returns the frame as an image from which load_frame() makes the same bits.
Image frame_image(const GBufferImage& gbuffer);

/// Returns every file that load_frame() reads.
std::vector<std::filesystem::path> frame_files(const std::filesystem::path& exr);

/// Returns the size of a frame from its header.
glm::ivec2 frame_size_px(const std::filesystem::path& exr);

} // namespace ssrlab
