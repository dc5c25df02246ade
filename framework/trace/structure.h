// A structure is a folder: structure.toml says what is derived from the G-buffer to trace faster, how much room it takes and
// which shaders build it; read.glsl is how techniques read it (docs/how-to/write_a_structure.md).
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

/// What there is one of: of a buffer's elements, or of a pass's invocations.
enum class SizeRule {
    pixel,      // of the image
    tile,       // squares of tile_px pixels
    cell,       // of every level above the pixels: 2^level pixels square
    depth_cell, // buffers: two words a cell in the depth's own buffer, whose level 0 is the depth; one structure at a time
    level,      // passes: a dispatch for each level, with an invocation for each of its cells
    ray_group, // 64 rays that follow each other in the list
};

/// An element has one, two or four words.
struct StructureBuffer {
    std::string name;
    SizeRule    per     = SizeRule::pixel;
    int         count   = 1; // elements each
    int         tile_px = 0; // per tile
    std::string type;        // of GLSL; real and real2 are double in the double twin; empty for depth_cell
};

struct StructurePass {
    std::filesystem::path          shader;
    PassStyle                      style       = PassStyle::by_device; // serial, parallel: only where passes are
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

/// The structures of these ids and all that they read, each after those. Throws SpecError "PLACE: …" for an unknown id, for
/// structures that read each other, and where two keep their cells in the depth's buffer.
std::vector<Structure> collect_structures(std::span<const std::string> ids, std::span<const Structure> known,
                                          const std::string& place);

} // namespace ssrlab
