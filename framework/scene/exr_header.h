// Checks the sizes in an EXR file before OpenEXR sees them.
#pragma once

#include <filesystem>
#include <string>

namespace ssrlab {

/// OpenEXR 3.1 takes sizes in a header at their word and asks for as much memory: up to 2 GB for one text of a file of 400 bytes. Refuses
/// what reaches beyond the file, and pictures and tiles that are too large. Throws Failure, SpecError for too many pixels; `shown` is the path as messages show it.
void check_exr_header(const std::filesystem::path& file, const std::string& shown);

} // namespace ssrlab
