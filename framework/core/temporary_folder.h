// A folder that lasts as long as its owner.
#pragma once

#include "core/error.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

namespace ssrlab {

/// Makes an empty folder in the system's place for temporary files, and removes it with its content at the end. Throws
/// Failure if it cannot be made.
struct TemporaryFolder {
    std::filesystem::path path;

    explicit TemporaryFolder(const std::string& prefix)
    {
        std::string name = (std::filesystem::temp_directory_path() / (prefix + "_XXXXXX")).string();
        if (::mkdtemp(name.data()) == nullptr) throw_failure("{}: cannot be created: {}", name, std::strerror(errno));
        path = name;
    }
    ~TemporaryFolder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }
    TemporaryFolder(const TemporaryFolder&)            = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
};

} // namespace ssrlab
