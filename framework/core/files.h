// Reading and writing whole files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace ssrlab {

/// Returns the whole file. Throws Failure with path and reason.
std::string read_file(const std::filesystem::path& path);

/// Returns everything from `fd` to its end. Throws Failure with the reason.
std::string read_to_end(int fd);

/// Returns a regular file. Throws Failure: missing, a folder, a pipe, larger than `limit_bytes`.
std::vector<unsigned char> read_regular_file(const std::filesystem::path& path, uint64_t limit_bytes);

/// Returns the size that read_regular_file() would return; throws likewise.
uint64_t regular_file_bytes(const std::filesystem::path& path, uint64_t limit_bytes);

/// Writes beside, syncs and renames: the name never carries a partial file. Throws Failure with the reason.
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

/// Writes everything to `fd`. Returns false, with errno set, if the rest was refused.
bool write_fully(int fd, std::string_view bytes);

/// Returns 16 hexadecimal digits that depend on every byte, equal on all machines and versions.
std::string content_hash(std::string_view bytes);

/// Returns one hash of all files below `folder` (names and contents). A missing folder hashes like an empty one.
std::string folder_hash(const std::filesystem::path& folder);

/// Returns the folder of the program's data (shaders/, techniques/, experiments/): share/ssrlab beside the program's
/// own folder. In a build folder that is a link to the source tree. Throws Failure if it does not exist.
const std::filesystem::path& data_root();

/// Returns the path relative to the current directory if it lies below it.
std::string short_path(const std::filesystem::path& path);

} // namespace ssrlab
