// Files that are either there completely or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace ssrlab {

/// The whole file; throws Failure with path and reason.
std::string read_file(const std::filesystem::path& path);

/// From `fd` to its end; throws Failure, with the reason alone.
std::string read_to_end(int fd);

/// A regular file of limited size, for what a person names; throws Failure (missing, a folder, a pipe, larger than `limit_bytes`).
std::vector<unsigned char> read_regular_file(const std::filesystem::path& path, uint64_t limit_bytes);

/// How many bytes read_regular_file() would return.
uint64_t regular_file_bytes(const std::filesystem::path& path, uint64_t limit_bytes);

/// Written beside, synced and renamed: the final name never carries a partial file. Throws Failure with path and reason.
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

/// Writes everything to `fd`, retrying interrupted and short writes. False with errno set when the rest was refused.
bool write_fully(int fd, std::string_view bytes);

/// 16 hexadecimal digits that depend on every byte; stable across machines and versions.
std::string content_hash(std::string_view bytes);

/// One hash of all files below `folder` (names and contents); an absent folder hashes as an empty one.
std::string folder_hash(const std::filesystem::path& folder);

/// Where the program's data lies (shaders/, techniques/, experiments/): the folder share/ssrlab beside the program's own. In a build folder that is a link
/// to the source tree. Throws Failure when it is not there.
const std::filesystem::path& data_root();

/// As a person at the current directory would type it.
std::string short_path(const std::filesystem::path& path);

} // namespace ssrlab
