#include "gpu/disk_cache.h"

#include "core/files.h"

#include <atomic>
#include <cstdio>
#include <cstdlib>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

// A file begins with the hash of its name and of what follows, 16 digits: one under another's name is not read.
constexpr size_t hash_bytes = 16;

std::string hash_of(const std::string& name, std::string_view bytes)
{
    return content_hash(std::string(name).append("\n").append(bytes));
}

void warn_once(const char* why) noexcept
{
    static std::atomic_flag warned;
    if (!warned.test_and_set()) std::fprintf(stderr, "warning: shaders are compiled anew, without a cache: %s\n", why);
}

} // namespace

fs::path cache_folder()
{
    const auto variable = [](const char* name) {
        const char* value = std::getenv(name);
        return fs::path(value != nullptr ? value : "");
    };
    if (const fs::path folder = variable("XDG_CACHE_HOME"); folder.is_absolute()) return folder / "ssrlab";
    if (const fs::path home = variable("HOME"); home.is_absolute()) return home / ".cache/ssrlab";
    return {};
}

std::optional<std::string> read_cached(const std::string& name)
{
    const fs::path folder = cache_folder();
    try {
        if (folder.empty() || !fs::is_regular_file(folder / name)) return std::nullopt;
        const std::string file = read_file(folder / name);
        const std::string rest = file.size() > hash_bytes ? file.substr(hash_bytes) : "";
        if (!rest.empty() && file.compare(0, hash_bytes, hash_of(name, rest)) == 0) return rest;
    } catch (const std::exception& error) { // unreadable is as good as absent
        warn_once(error.what());
    }
    return std::nullopt;
}

void write_cached(const std::string& name, std::string_view bytes) noexcept
{
    try {
        const fs::path folder = cache_folder();
        if (folder.empty()) return;
        fs::create_directories(folder);
        write_file_atomically(folder / name, hash_of(name, bytes).append(bytes));
    } catch (const std::exception& error) { // made anew next time
        warn_once(error.what());
    }
}

} // namespace ssrlab
