// A picture in memory: interleaved float channels with names.
#pragma once

#include <glm/glm.hpp>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace ssrlab {

struct Image {
    glm::ivec2                         size_px{0, 0};
    std::vector<std::string>           channels; // e.g. {"R", "G", "B"}
    std::vector<float>                 values;   // row-major, interleaved: size.x * size.y * channels.size()
    std::map<std::string, std::string> metadata; // written as EXR attributes
};

} // namespace ssrlab
