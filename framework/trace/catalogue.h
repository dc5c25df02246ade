// What was found on disk: every folder with a technique, a structure, a surface model or a reprojection strategy.
#pragma once

#include "trace/reprojection_strategy.h"
#include "trace/technique.h"

namespace ssrlab {

struct Catalogue {
    std::vector<Technique>    techniques;
    std::vector<Structure>    structures;
    std::vector<Surface>      surfaces;
    std::vector<Reprojection> reprojections; // what frames do with hits; found in the same folders
};

/// The project's own, then those in $SSRLAB_TECHNIQUES (colon-separated) and `extra_dirs`. Each directory is a folder of one
/// of them or holds such folders. Throws SpecError when two of a kind share an id, a directory does not exist or holds
/// none of them, and for what load_technique() and its like refuse.
Catalogue load_catalogue(std::span<const std::filesystem::path> extra_dirs = {});

/// The one of that id; throws SpecError listing the known ones.
const Technique&    find_technique(std::span<const Technique> techniques, const std::string& id);
const Surface&      find_surface(std::span<const Surface> surfaces, const std::string& id);
const Reprojection& find_reprojection(std::span<const Reprojection> reprojections, const std::string& id);

} // namespace ssrlab
