#include "harness/result_folder.h"

#include "core/error.h"
#include "core/files.h"
#include "harness/passes.h"
#include "harness/samples.h"

#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <fmt/ranges.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <thread>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

std::string to_json(const Environment& environment)
{
    nlohmann::ordered_json json;
    for (const auto& [key, value] : environment.notes) json[key] = value;
    json["identity"] = environment.identity;
    // Text that is not UTF-8 (a file name, say) must not stop a sweep.
    return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

/// Has it lost the process that watches over the sweep? Then it is being killed.
bool is_orphan(const std::string& pid)
{
    std::ifstream status("/proc/" + pid + "/status");
    for (std::string line; std::getline(status, line);)
        if (line == "PPid:\t1") return true;
    return false;
}

std::map<std::string, std::string> recorded_identity(const fs::path& file)
{
    try {
        return nlohmann::json::parse(read_file(file)).at("identity").get<std::map<std::string, std::string>>();
    } catch (const nlohmann::json::exception& error) {
        throw_failure("{}: damaged: {}", short_path(file), error.what());
    }
}

/// What stands behind the first line.
std::string_view take_header(std::string_view text, const fs::path& file, const CsvRecord& header)
{
    if (take_csv_record(text) != header)
        throw_failure("{}: damaged: its first line is not '{}'", short_path(file), fmt::join(header, ","));
    return text;
}

} // namespace

void refuse_old_form(const fs::path& results_csv, const CsvRecord& header)
{
    if (std::ranges::count(header, "passes_why") + std::ranges::count(header, "passes") == 0) return;
    throw_spec_error("{}: an older ssrlab wrote it, without passes.csv; measure it anew: ssrlab run SPECIFICATION.toml "
                     "-o ANOTHER_FOLDER",
                     short_path(results_csv));
}

std::vector<std::string> differences(const std::map<std::string, std::string>& a,
                                     const std::map<std::string, std::string>& b)
{
    std::vector<std::string> names;
    for (const auto& [name, value] : a) {
        if (!b.contains(name) || b.at(name) != value) names.push_back(name);
    }
    for (const auto& [name, value] : b) {
        if (!a.contains(name)) names.push_back(name);
    }
    return names;
}

ResultFolder::ResultFolder(fs::path folder, std::vector<Column> columns, const Environment& environment, bool resuming,
                           bool retry)
    : folder_(std::move(folder)), csv_(folder_ / "results.csv"), samples_(folder_ / "samples.csv"),
      passes_(folder_ / "passes.csv"), columns_(std::move(columns))
{
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error) throw_failure("{}: cannot be created: {}", short_path(folder_), error.message());
    try {
        lock();
        if (fs::exists(csv_) && !resuming) {
            throw_spec_error("{}: already there; continue it with --resume, or choose another folder with -o",
                             short_path(csv_));
        }
        remove_partial_files();
        if (fs::exists(csv_))
            resume(environment, retry);
        else
            start(environment);
    } catch (...) {
        for (const int fd : {csv_fd_, samples_fd_, passes_fd_, lock_fd_})
            if (fd >= 0) ::close(fd);
        throw;
    }
}

ResultFolder::~ResultFolder()
{
    ::close(csv_fd_);
    ::close(samples_fd_);
    ::close(passes_fd_);
    ::close(lock_fd_); // releases the lock; so does the end of the process, however it ends
}

void ResultFolder::lock()
{
    const fs::path file = folder_ / ".lock";
    lock_fd_            = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (lock_fd_ < 0) throw_failure("{}: cannot be written: {}", short_path(file), std::strerror(errno));
    // A sweep that was just killed may have a child that is still ending: on a busy machine for some seconds.
    bool locked = false;
    for (int i = 0; !locked && (i < 20 || (i < 300 && is_orphan(read_file(file)))); ++i) {
        if (i > 0) std::this_thread::sleep_for(std::chrono::milliseconds(100));
        locked = ::flock(lock_fd_, LOCK_EX | LOCK_NB) == 0;
        if (!locked && errno != EWOULDBLOCK)
            throw_failure("{}: cannot be locked: {}", short_path(file), std::strerror(errno));
    }
    if (!locked) throw_failure("{}: another ssrlab is writing here (process {})", short_path(folder_), read_file(file));
    const std::string pid = std::to_string(::getpid());
    if (::ftruncate(lock_fd_, 0) != 0 || !write_fully(lock_fd_, pid)) {
        throw_failure("{}: cannot be written: {}", short_path(file), std::strerror(errno));
    }
}

void ResultFolder::start(const Environment& environment)
{
    write_file_atomically(folder_ / "environment.json", to_json(environment));
    write_file_atomically(samples_, csv_line(sample_columns()));
    write_file_atomically(passes_, csv_line(names_of(pass_columns())));
    // Last, because a results.csv promises that everything else is there.
    write_file_atomically(csv_, csv_line(names_of(columns_)));
    open_files();
}

void ResultFolder::open_files()
{
    for (const auto& [file, fd] :
         {std::pair{&csv_, &csv_fd_}, std::pair{&samples_, &samples_fd_}, std::pair{&passes_, &passes_fd_}}) {
        *fd = ::open(file->c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
        if (*fd < 0) throw_failure("{}: cannot be written: {}", short_path(*file), std::strerror(errno));
    }
}

void ResultFolder::resume(const Environment& environment, bool retry)
{
    const auto changed = differences(recorded_identity(folder_ / "environment.json"), environment.identity);
    if (!changed.empty()) {
        throw_spec_error("{}: cannot be resumed, since it was started these changed: {}; choose another folder with -o",
                         short_path(folder_), fmt::join(changed, ", "));
    }
    const std::string text   = read_file(csv_);
    std::string_view  rest   = text;
    const auto        header = take_csv_record(rest);
    if (header) refuse_old_form(csv_, *header);
    if (header != names_of(columns_)) {
        throw_spec_error(
            "{}: cannot be resumed, its columns are not those of this version; choose another folder with -o",
            short_path(csv_));
    }
    const std::string  samples = read_file(samples_), passes = read_file(passes_);
    std::string_view   sample_rest = take_header(samples, samples_, sample_columns());
    std::string_view   pass_rest   = take_header(passes, passes_, names_of(pass_columns()));
    const SampleCounts counts      = count_samples(sample_rest);
    next_round_                    = counts.next_round;
    // Each file is replaced as a whole: a kill in between leaves the old one, and resuming again comes to the same.
    const std::string kept = finished_rows(rest, counts, count_passes(pass_rest), retry);
    if (kept != text) write_file_atomically(csv_, kept);
    const std::string kept_samples = lines_of(sample_columns(), sample_rest, finished_);
    if (kept_samples != samples) write_file_atomically(samples_, kept_samples);
    const std::string kept_passes = lines_of(names_of(pass_columns()), pass_rest, finished_);
    if (kept_passes != passes) write_file_atomically(passes_, kept_passes);
    open_files();
}

/// Header and rows that stand: not those whose samples or passes are incomplete, not those that failed with `retry`,
/// and not a last one that a kill tore. `passes`: how many of each run ran.
std::string ResultFolder::finished_rows(std::string_view rows, const SampleCounts& samples,
                                        const std::map<std::string, int64_t>& passes, bool retry)
{
    const auto lacks = [](const Record& row, const char* column, const auto& counts) {
        const auto said  = number_of(row, column);
        const auto found = counts.find(words_of(row, "run_id"));
        return said && (found == counts.end() || static_cast<double>(found->second) != *said);
    };
    std::string           kept = csv_line(names_of(columns_));
    std::set<std::string> seen;
    while (const auto record = take_csv_record(rows)) {
        if (record->size() != columns_.size() || !seen.insert(record->front()).second) {
            throw_failure("{}: damaged: the row of run '{}' {}", short_path(csv_), record->front(),
                          record->size() != columns_.size() ? "has the wrong number of fields" : "is there twice");
        }
        const Record      row = record_of(*record, columns_);
        const std::string how = words_of(row, "outcome");
        if (retry && (how == "failed" || how == "invalid")) continue;
        if (lacks(row, "repeats", samples.frames) || lacks(row, "passes_ran", passes)) continue;
        kept += csv_line(*record);
        finished_.insert(record->front());
    }
    return kept;
}

/// Rows in a file that nobody will find are lost, and a lock that is gone lets a second writer in.
void ResultFolder::require_unmoved(const fs::path& file, int fd) const
{
    struct stat ours = {}, there = {};
    const bool  same = ::fstat(fd, &ours) == 0 && ::stat(file.c_str(), &there) == 0 && ours.st_dev == there.st_dev &&
                      ours.st_ino == there.st_ino;
    if (!same) throw_failure("{}: was removed or replaced while it was in use", short_path(file));
}

void ResultFolder::require_unmoved() const
{
    require_unmoved(csv_, csv_fd_);
    require_unmoved(samples_, samples_fd_);
    require_unmoved(passes_, passes_fd_);
    require_unmoved(folder_ / ".lock", lock_fd_);
}

namespace {

/// One checked write and a sync; on failure what was written is cut off again.
void append_whole(int fd, const fs::path& file, std::string_view bytes, const std::string& what)
{
    struct stat before = {};
    if (::fstat(fd, &before) != 0) throw_failure("{}: {}", short_path(file), std::strerror(errno));
    if (write_fully(fd, bytes) && ::fdatasync(fd) == 0) return;
    const int  reason = errno;
    const bool cut    = ::ftruncate(fd, before.st_size) == 0;
    throw_failure("{}: writing {} failed: {}{}", short_path(file), what, std::strerror(reason),
                  cut ? "; the rows before it are intact, continue with --resume" : "");
}

} // namespace

void ResultFolder::append(const Record& row, std::string_view samples, std::string_view passes)
{
    const auto known = [&](const auto& entry) {
        return std::ranges::find(columns_, entry.first, &Column::name) != columns_.end();
    };
    const auto stray = std::ranges::find_if_not(row, known);
    if (stray != row.end()) throw_failure("{}: has no column '{}'", short_path(csv_), stray->first);

    const std::string id = words_of(row, "run_id");
    require_unmoved();
    if (!samples.empty()) append_whole(samples_fd_, samples_, samples, "the samples of run " + id);
    if (!passes.empty()) append_whole(passes_fd_, passes_, passes, "the passes of run " + id);
    append_whole(csv_fd_, csv_, csv_line(fields_of(row, columns_)), "the row of run " + id);
    finished_.insert(id);
}

std::map<std::string, Record> ResultFolder::rows() const
{
    std::map<std::string, Record> rows;
    const std::string             text = read_file(csv_);
    std::string_view              rest = text;
    take_csv_record(rest); // the header
    while (const auto fields = take_csv_record(rest)) rows[fields->front()] = record_of(*fields, columns_);
    return rows;
}

/// What a killed writer left beside its files; nothing that only looks alike.
void ResultFolder::remove_partial_files() const
{
    std::vector<fs::path> partial;
    for (const fs::path& folder : {folder_, folder_ / "pictures"}) {
        if (!fs::is_directory(folder)) continue;
        for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
            const std::string name = entry.path().filename().string();
            const bool        text = name.starts_with("environment.json.tmp") || name.starts_with("results.csv.tmp") ||
                              name.starts_with("samples.csv.tmp") || name.starts_with("passes.csv.tmp") ||
                              name.starts_with("sequence_summary.csv.tmp");
            const bool picture = name.starts_with(".") && name.find(".tmp.") != std::string::npos;
            if (text || (picture && folder != folder_)) partial.push_back(entry.path());
        }
    }
    for (const fs::path& path : partial) fs::remove(path);
}

} // namespace ssrlab
