// The passes of an export: the lab's, with one before them for the depth and one for the rays. Folder-internal.
#pragma once

#include "export/export.h"
#include "trace/composed.h"

#include <map>
#include <set>

namespace ssrlab {

struct ExportedPass {
    std::string                     name; // of the file, without its ending: "2_depth_pyramid_level_of_pixels"
    std::string                     glsl;
    ComposedPass                    pass;
    bool                            sets_up_rays = false;
    std::map<uint32_t, std::string> bindings     = {}; // resource of each binding, by the names of resource_of()
    std::map<uint32_t, std::string> registers    = {}; // of HLSL, by its binding: "t10"
};

/// Throws SpecError for what an export cannot hold.
std::vector<ExportedPass> export_passes(Gpu& gpu, const Lab& lab, const ComposedLab& composed,
                                        const std::set<std::string>& kept);

/// The host's resource behind a name of a shader: several names may stand for one buffer. Throws SpecError for one that
/// an export does not have.
std::string resource_of(const std::string& name, const ComposedLab& composed, const std::string& file);

/// "frames" and "expected" of the folder.
void write_frame(Gpu& gpu, const Lab& lab, const ComposedLab& composed, std::span<const ExportedPass> passes,
                 const ExportFrame& frame, std::span<const RayInput> rays, std::span<const RayOutcome> outcomes,
                 ExportLanguage language, const std::filesystem::path& folder);

/// What an engine's programmer has to know, as Markdown without headings above the second level.
struct Cost {
    std::string frame;
    double      steps = 0, depth_fetches = 0, structure_fetches = 0; // means over its rays
};
std::string readme(const Export& what, const View& view, std::span<const ExportedPass> passes,
                   const ComposedLab& composed, const Cost& cost);
/// The same in one screen of comment, for the file of the trace.
std::string head_comment(const Export& what, const View& view, const ExportedPass& trace);

} // namespace ssrlab
