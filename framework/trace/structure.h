// A structure is a folder: structure.toml declares its buffers and the shaders that build it from the G-buffer;
// techniques read it through read.glsl (docs/how-to/write_a_structure.md).
#pragma once

#include "gpu/gpu.h"
#include "trace/parameter.h"

#include <glm/glm.hpp>

#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace ssrlab {

/// The unit that a buffer has elements for, or a pass invocations.
enum class SizeRule {
    pixel,      // of the image
    tile,       // squares of tile_px pixels
    cell,       // of every level above the pixels: 2^level pixels square
    depth_cell, // buffers: two words per cell in the depth's own buffer, whose level 0 is the depth; one structure only
    level,      // passes: one dispatch per level, one invocation per cell
    ray_group,  // 64 consecutive rays of the list
};

/// An element has one, two or four words.
struct StructureBuffer {
    std::string name;
    SizeRule    per     = SizeRule::pixel;
    int         count   = 1; // elements per unit
    int         tile_px = 0; // per tile
    std::string type;        // of GLSL; real and real2 are double in the double twin; empty for depth_cell
};

struct StructurePass {
    std::filesystem::path          shader;
    PassStyle                      style       = PassStyle::by_device; // serial, parallel: only where passes are so
    SizeRule                       per         = SizeRule::pixel;
    int                            tile_px     = 0;  // per tile
    int                            first_level = 1;  // per level
    std::variant<int, std::string> last_level  = 31; // a number, or the name of an integer parameter
    int                            levels_per_dispatch = 1;
    glm::ivec2                     cells_per_invocation{1, 1};
};

struct Structure {
    std::string                  id; // the folder's name
    std::string                  name;
    std::string                  summary;
    std::vector<std::string>     cite;
    std::vector<std::string>     reads;      // ids of structures that are built before
    std::vector<Parameter>       parameters; // named "id.parameter"
    std::vector<StructureBuffer> buffers;
    std::vector<StructurePass>   passes;
    std::filesystem::path        folder;
};

/// Reads folder/structure.toml; throws SpecError with file and line.
Structure load_structure(const std::filesystem::path& folder);

/// Returns the structures with these ids and all that they read, in the order of building. Throws SpecError "PLACE: …"
/// for an unknown id, for structures that read each other, and if two keep their cells in the depth's buffer.
std::vector<Structure> collect_structures(std::span<const std::string> ids, std::span<const Structure> known,
                                          const std::string& place);

} // namespace ssrlab
