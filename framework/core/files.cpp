#include "core/files.h"

#include "core/error.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

/// Makes a rename durable; a file system that cannot sync a folder loses nothing that we promised.
void sync_folder(const fs::path& folder)
{
    const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd < 0) return;
    ::fsync(fd);
    ::close(fd);
}

/// Open for reading. A pipe would wait for a writer that never comes, a device may have no end.
struct RegularFile {
    int      descriptor = -1;
    uint64_t bytes      = 0;

    explicit RegularFile(const fs::path& path, uint64_t limit_bytes = UINT64_MAX)
        : descriptor(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC))
    {
        if (descriptor < 0) throw_failure("{}: cannot be read: {}", short_path(path), std::strerror(errno));
        struct stat info {};
        if (::fstat(descriptor, &info) != 0 || !S_ISREG(info.st_mode)) {
            ::close(descriptor);
            throw_failure("{}: not a regular file", short_path(path));
        }
        bytes = static_cast<uint64_t>(info.st_size);
        if (bytes > limit_bytes) {
            ::close(descriptor);
            throw_failure("{}: {} bytes, but at most {} can be loaded", short_path(path), bytes, limit_bytes);
        }
    }
    RegularFile(const RegularFile&)            = delete;
    RegularFile& operator=(const RegularFile&) = delete;
    ~RegularFile() { ::close(descriptor); }
};

} // namespace

std::string read_to_end(int fd)
{
    std::string       bytes;
    std::vector<char> block(1 << 16);
    for (;;) {
        const ssize_t count = ::read(fd, block.data(), block.size());
        if (count == 0) return bytes;
        if (count > 0)
            bytes.append(block.data(), static_cast<size_t>(count));
        else if (errno != EINTR)
            throw_failure("reading failed: {}", std::strerror(errno));
    }
}

std::string read_file(const fs::path& path)
{
    if (fs::is_directory(path)) throw_failure("{}: is a folder, not a file", short_path(path));
    const RegularFile file(path);
    try {
        return read_to_end(file.descriptor); // files of /proc say that they are empty
    } catch (const Failure& failure) {
        throw_failure("{}: {}", short_path(path), failure.what());
    }
}

std::vector<unsigned char> read_regular_file(const fs::path& path, uint64_t limit_bytes)
{
    const RegularFile          file(path, limit_bytes);
    std::vector<unsigned char> bytes(file.bytes);
    for (size_t done = 0; done < bytes.size();) {
        const ssize_t count = ::read(file.descriptor, bytes.data() + done, bytes.size() - done);
        if (count <= 0) throw_failure("{}: cannot be read to its end", short_path(path));
        done += static_cast<size_t>(count);
    }
    return bytes;
}

uint64_t regular_file_bytes(const fs::path& path, uint64_t limit_bytes) { return RegularFile(path, limit_bytes).bytes; }

bool write_fully(int fd, std::string_view bytes)
{
    while (!bytes.empty()) {
        const ssize_t written = ::write(fd, bytes.data(), bytes.size());
        if (written > 0) {
            bytes.remove_prefix(static_cast<size_t>(written));
        } else if (written == 0) {
            errno = EIO;
            return false;
        } else if (errno != EINTR) {
            return false;
        }
    }
    return true;
}

void write_file_atomically(const fs::path& path, std::string_view bytes)
{
    // The name is per process: two writers of the same file must not share the temporary one.
    const fs::path beside = path.string() + fmt::format(".tmp{}", ::getpid());
    const int      fd     = ::open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (fd < 0) throw_failure("{}: cannot be created: {}", short_path(path), std::strerror(errno));
    bool      complete = write_fully(fd, bytes) && ::fsync(fd) == 0;
    const int reason   = errno;
    complete           = ::close(fd) == 0 && complete;
    if (!complete || ::rename(beside.c_str(), path.c_str()) != 0) {
        const int why = complete ? errno : reason;
        ::unlink(beside.c_str());
        throw_failure("{}: writing failed: {}", short_path(path), std::strerror(why));
    }
    sync_folder(path.has_parent_path() ? path.parent_path() : ".");
}

std::string content_hash(std::string_view bytes)
{
    return fmt::format("{:016x}", XXH3_64bits(bytes.data(), bytes.size()));
}

std::string folder_hash(const fs::path& folder)
{
    std::vector<fs::path> files;
    if (fs::is_directory(folder)) {
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
            if (entry.is_regular_file()) files.push_back(entry.path());
        }
    }
    std::ranges::sort(files);
    std::string listing;
    for (const fs::path& file : files) {
        listing += fmt::format("{} {}\n", file.lexically_relative(folder).string(), content_hash(read_file(file)));
    }
    return content_hash(listing);
}

const fs::path& data_root()
{
    static const fs::path root = [] {
        const fs::path  beside = fs::read_symlink("/proc/self/exe").parent_path().parent_path() / "share/ssrlab";
        std::error_code error;
        const fs::path  found = fs::canonical(beside, error);
        if (error || !fs::is_directory(found / "shaders"))
            throw_failure("{}: the program's shaders are not there; build or install it again", beside.string());
        return found;
    }();
    return root;
}

std::string short_path(const fs::path& path)
{
    std::error_code error;
    const fs::path  here     = fs::current_path(error);
    const fs::path  relative = path.is_absolute() && !error ? path.lexically_relative(here) : path;
    return relative.empty() || *relative.begin() == ".." ? path.string() : relative.string();
}

} // namespace ssrlab
