// The hard cases as frame files with their right answers, for engines (docs/how-to/judge_a_renderer.md).
#pragma once

#include "app/commands.h"

namespace ssrlab {

/// Writes frames/, expected/ and manifest.json into a new or empty folder. Throws SpecError for another folder, Failure
/// if a closed form and the contract disagree.
int export_cases(const CommonOptions& common, const std::string& folder);

/// A frame of such a folder.
struct ExportedCase {
    std::string              name;
    std::filesystem::path    frame;
    std::vector<std::string> settings; // name=value of [trace]
};

/// Reads manifest.json of the folder. Throws SpecError if there is none, or if it is damaged.
std::vector<ExportedCase> read_cases(const std::filesystem::path& folder);

/// Traces every frame of the folder under its own settings, into a folder of hits files.
int trace_cases(const CommonOptions& common, const PictureOptions& options);

} // namespace ssrlab
