// A reprojection strategy is a folder: reprojection.toml describes it, reproject.glsl says where a reflection was in
// the frame before (docs/explanation/motion.md).
#pragma once

#include "trace/parameter.h"

#include <filesystem>
#include <string>
#include <vector>

namespace ssrlab {

struct Reprojection {
    std::string              id; // the folder's name
    std::string              name;
    std::string              summary;
    std::vector<std::string> cite;
    std::vector<Parameter>   parameters; // named "id.parameter"
    std::filesystem::path    folder;
};

/// Reads folder/reprojection.toml; throws SpecError with file and line.
Reprojection load_reprojection(const std::filesystem::path& folder);

} // namespace ssrlab
