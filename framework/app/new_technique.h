// ssrlab new-technique: a folder to begin with.
#pragma once

#include <filesystem>

namespace ssrlab {

/// Writes technique.toml and trace.glsl of a tracer that passes ssrlab check; the folder's name is the technique's id.
/// Throws SpecError for a folder that is already there or a name that cannot be one.
int write_new_technique(const std::filesystem::path& folder);

} // namespace ssrlab
