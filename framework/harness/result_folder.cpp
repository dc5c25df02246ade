#include "harness/result_folder.h"

#include "core/error.h"
#include "core/files.h"
#include "harness/passes.h"
#include "harness/samples.h"
#include "harness/source_rows.h"

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
    if (!environment.figures.empty()) json["figures"] = nlohmann::ordered_json::parse(environment.figures);
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

} // namespace

void refuse_old_form(const fs::path& csv, const CsvRecord& header)
{
    const auto  has   = [&](const char* column) { return std::ranges::count(header, column) > 0; };
    const char* lacks = has("passes_why") || has("passes")                     ? "passes.csv"
                        : has("passes_ran") && !has("sources_asked")           ? "sources.csv"
                        : has("pass") && has("ran") && !has("bytes_read_mean") ? "bytes_read_mean"
                                                                               : nullptr;
    if (lacks == nullptr) return;
    throw_spec_error("{}: an older ssrlab wrote it, without {}; measure it anew: ssrlab run SPECIFICATION.toml "
                     "-o ANOTHER_FOLDER",
                     short_path(csv), lacks);
}

std::string_view take_header(std::string_view text, const fs::path& file, const CsvRecord& header)
{
    const auto found = take_csv_record(text);
    if (found) refuse_old_form(file, *found);
    if (found != header)
        throw_failure("{}: damaged: its first line is not '{}'", short_path(file), fmt::join(header, ","));
    return text;
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
    : folder_(std::move(folder)), csv_(folder_ / "results.csv"),
      beside_({{{folder_ / "samples.csv", sample_columns(), &RunLines::samples},
                {folder_ / "passes.csv", names_of(pass_columns()), &RunLines::passes},
                {folder_ / "sources.csv", names_of(source_file_columns()), &RunLines::sources}}}),
      columns_(std::move(columns))
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
        close_files();
        throw;
    }
}

ResultFolder::~ResultFolder() { close_files(); }

void ResultFolder::close_files() const
{
    for (const SideFile& file : beside_)
        if (file.fd >= 0) ::close(file.fd);
    if (csv_fd_ >= 0) ::close(csv_fd_);
    if (lock_fd_ >= 0) ::close(lock_fd_); // releases the lock; so does the end of the process, however it ends
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
    for (const SideFile& file : beside_) write_file_atomically(file.path, csv_line(file.header));
    // Last, because a results.csv promises that everything else is there.
    write_file_atomically(csv_, csv_line(names_of(columns_)));
    open_files();
}

void ResultFolder::open_files()
{
    const auto open = [](const fs::path& file) {
        const int fd = ::open(file.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
        if (fd < 0) throw_failure("{}: cannot be written: {}", short_path(file), std::strerror(errno));
        return fd;
    };
    csv_fd_ = open(csv_);
    for (SideFile& file : beside_) file.fd = open(file.path);
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
    std::vector<std::string>      texts;
    std::vector<std::string_view> rests;
    for (const SideFile& file : beside_) texts.push_back(read_file(file.path));
    for (size_t i = 0; i < beside_.size(); ++i)
        rests.push_back(take_header(texts[i], beside_[i].path, beside_[i].header));
    // Each file is replaced as a whole: a kill in between leaves the old one, and resuming again comes to the same.
    const std::string kept = finished_rows(rest, rests, retry);
    if (kept != text) write_file_atomically(csv_, kept);
    for (size_t i = 0; i < beside_.size(); ++i) {
        const std::string kept_lines = lines_of(beside_[i].header, rests[i], finished_);
        if (kept_lines != texts[i]) write_file_atomically(beside_[i].path, kept_lines);
    }
    open_files();
}

/// Header and rows that stand: not those whose other lines are incomplete, not those that failed with `retry`, and not a
/// last one that a kill tore. `beside`: the records of the files beside results.csv.
std::string ResultFolder::finished_rows(std::string_view rows, std::span<const std::string_view> beside, bool retry)
{
    const SampleCounts samples = count_samples(beside[0]);
    const auto         passes = count_passes(beside[1]), sources = count_sources(beside[2]);
    next_round_      = samples.next_round;
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
        if (lacks(row, "sources_asked", sources)) continue;
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
    for (const SideFile& file : beside_) require_unmoved(file.path, file.fd);
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

void ResultFolder::append(const Record& row, const RunLines& lines)
{
    const auto known = [&](const auto& entry) {
        return std::ranges::find(columns_, entry.first, &Column::name) != columns_.end();
    };
    const auto stray = std::ranges::find_if_not(row, known);
    if (stray != row.end()) throw_failure("{}: has no column '{}'", short_path(csv_), stray->first);

    const std::string id = words_of(row, "run_id");
    require_unmoved();
    for (const SideFile& file : beside_)
        if (const std::string& own = lines.*file.lines; !own.empty())
            append_whole(file.fd, file.path, own, "the lines of run " + id);
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
            const bool        text =
                std::ranges::any_of(std::array{"environment.json.tmp", "results.csv.tmp", "samples.csv.tmp",
                                               "passes.csv.tmp", "sources.csv.tmp", "sequence_summary.csv.tmp"},
                                    [&](const char* start) { return name.starts_with(start); });
            const bool picture = name.starts_with(".") && name.find(".tmp.") != std::string::npos;
            if (text || (picture && folder != folder_)) partial.push_back(entry.path());
        }
    }
    for (const fs::path& path : partial) fs::remove(path);
}

} // namespace ssrlab
