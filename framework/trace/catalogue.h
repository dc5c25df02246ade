// The folders found on disk: techniques, structures, surface models and reprojection strategies.
#pragma once

#include "trace/reprojection_strategy.h"
#include "trace/technique.h"

namespace ssrlab {

struct Catalogue {
    std::vector<Technique>    techniques;
    std::vector<Structure>    structures;
    std::vector<Surface>      surfaces;
    std::vector<Reprojection> reprojections;
};

/// Returns the project's own folders, then those in $SSRLAB_TECHNIQUES (separated by colons) and `extra_dirs`; each
/// directory is such a folder or holds some. Throws SpecError if two of a kind share an id, if a directory is missing
/// or holds none, and for every manifest that load_technique(), load_structure() … refuse.
Catalogue load_catalogue(std::span<const std::filesystem::path> extra_dirs = {});

/// On the command line, the fastest technique that claims to be exact (harness/choose_technique.h). No folder may have
/// this name, and find_technique() refuses it: it says that a name is needed.
inline constexpr const char* fastest_exact = "exact";

/// Return the entry with this id; throw SpecError with the known ids if there is none.
const Technique&    find_technique(std::span<const Technique> techniques, const std::string& id);
const Surface&      find_surface(std::span<const Surface> surfaces, const std::string& id);
const Reprojection& find_reprojection(std::span<const Reprojection> reprojections, const std::string& id);

} // namespace ssrlab
