// Checks the sizes in an EXR file before OpenEXR sees them.
#pragma once

#include <filesystem>
#include <string>

namespace ssrlab {

/// Throws Failure for what reaches beyond the file and for tiles that are too large, SpecError for too many pixels.
/// OpenEXR 3.1 would ask for the memory that a header names: 2 GB for one of 400 bytes. `shown`: the path in messages.
void check_exr_header(const std::filesystem::path& file, const std::string& shown);

} // namespace ssrlab
