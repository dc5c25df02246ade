// How what exported shaders found is compared with an export's expected/. Folder-internal.
#pragma once

#include "export/export.h"

#include <nlohmann/json_fwd.hpp>

#include <functional>

namespace ssrlab {

using Words = std::vector<uint32_t>;

/// What the shaders wrote for one frame, as README.md of an export says.
struct Answers {
    Words  hits;
    Words  made_rays  = {}; // of the ray set-up, in any order; empty where the frame does without it
    size_t made_count = 0;
};

/// Returns the words of a file. Throws Failure if it cannot be read.
Words read_words(const std::filesystem::path& path);

/// Calls visit(file) for each frames/*.json of the folder, by name. Throws SpecError for a folder without any, and for
/// a file that lacks what `visit` looks for.
void for_each_frame(const std::filesystem::path&                             folder,
                    const std::function<void(const std::filesystem::path&)>& visit);

/// Throws SpecError where a resource of the frame, or a file with its content or its answers, has another size than the
/// frame's image and rays need. Buffers of structures have the size that the frame says.
/// file: the JSON file of the frame.
void require_sizes(const nlohmann::json& frame, const std::filesystem::path& file);

/// file: the JSON file of the frame.
FrameVerdict compare_answers(const nlohmann::json& frame, const std::filesystem::path& file, const Answers& answers);

} // namespace ssrlab
