// A frame of another renderer: an EXR with depth, normals and materials, and a small file that says what its numbers mean.
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

/// docs/reference/frame_files.md says what is read. Throws SpecError (what a person can write otherwise) or Failure (a damaged file), naming file
/// and channel, what was expected and what is there.
Frame load_frame(const std::filesystem::path& exr);

/// The same as an image, from which load_frame() makes the same bits.
Image frame_image(const GBufferImage& gbuffer);

/// Every file that load_frame() reads.
std::vector<std::filesystem::path> frame_files(const std::filesystem::path& exr);

/// The pixels of a frame, from its header.
glm::ivec2 frame_size_px(const std::filesystem::path& exr);

} // namespace ssrlab
