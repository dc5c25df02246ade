// Hit files: what each ray of a frame found, as an EXR (docs/reference/hit_files.md).
#pragma once

#include "core/image.h"
#include "core/trace_image.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace ssrlab {

/// One entry per pixel. What the file lacks is zero, and the flags say so.
struct HitsFile {
    std::string                        shown;  // the path as messages show it
    TraceImage                         result; // an unknown status is `impossible`, and steps holds its number
    bool                               has_status = true; // false: it tells only hits from misses
    bool                               has_point = true, has_pixel = true, has_t = true, has_z = true; // of hits
    bool                               has_steps = true;
    std::map<std::string, std::string> attributes; // those that are text
    std::vector<std::string>           warnings;
};

/// Returns the file of a trace: its answers, and its work if that was counted.
Image hits_image(const TraceImage& result);

/// Reads a file of `size_px`. Throws SpecError for missing files and channels and for another size, Failure for damage.
HitsFile read_hits(const std::filesystem::path& exr, glm::ivec2 size_px);

/// Returns the name=value pairs that `ssrlab trace` stored in the file; empty for files of other renderers.
std::vector<std::string> stated_parameters(const HitsFile& hits);

} // namespace ssrlab
