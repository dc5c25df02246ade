// A results folder: results.csv has a row for each run, written whole or not at all, samples.csv the timed frames
// behind the rows, passes.csv the passes of their frames, sources.csv the sources that were asked.
#pragma once

#include "harness/record.h"

#include <array>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace ssrlab {

/// The origin of results, as written to environment.json.
struct Environment {
    std::map<std::string, std::string> identity; // must be equal when a sweep is resumed
    std::map<std::string, std::string> notes;
    std::string                        figures; // resolve_figures()
};

/// Returns the names of entries that differ or that only one of the two has.
std::vector<std::string> differences(const std::map<std::string, std::string>& a,
                                     const std::map<std::string, std::string>& b);

/// Throws SpecError if an older version wrote this results.csv or passes.csv: it packed the times of passes into
/// columns, wrote no sources.csv, or counted no bytes.
void refuse_old_form(const std::filesystem::path& csv, const CsvRecord& header);
/// Returns what stands behind the first line. Throws likewise, and Failure if that line is not `header`.
std::string_view take_header(std::string_view text, const std::filesystem::path& file, const CsvRecord& header);

/// A run's lines of the files beside results.csv.
struct RunLines {
    std::string samples, passes, sources;
};

/// A results folder open for writing, locked against other writers until it is destroyed.
class ResultFolder {
public:
    /// Without `resume`: creates the folder, environment.json and the header; throws Failure if it has results.
    /// With it: removes a torn row, rows that lack samples, passes or sources, those without a row and, with `retry`,
    /// rows of failed runs, so that these runs are tried again. Throws SpecError that names what differs in
    /// columns or identity.
    ResultFolder(std::filesystem::path folder, std::vector<Column> columns, const Environment& environment, bool resume,
                 bool retry = true);
    ~ResultFolder();
    ResultFolder(const ResultFolder&)            = delete;
    ResultFolder& operator=(const ResultFolder&) = delete;

    /// Returns the runs that have a row.
    const std::set<std::string>& finished() const { return finished_; }

    /// Returns the rows by run id.
    std::map<std::string, Record> rows() const;

    /// Returns a number above every round in samples.csv.
    int next_round() const { return next_round_; }

    /// Writes the run's samples, passes and sources, then its row, each by one checked write with a sync. If that
    /// fails, it removes the torn bytes and throws a Failure that names the file: a row always has its other lines.
    void append(const Record& row, const RunLines& lines = {});

    /// Throws Failure if the folder's files are no longer those that were opened.
    void require_unmoved() const;

    const std::filesystem::path& path() const { return folder_; }

private:
    /// A file beside results.csv, whose lines begin with a run's id.
    struct SideFile {
        std::filesystem::path path;
        CsvRecord             header;
        std::string RunLines::*lines;
        int                    fd = -1;
    };

    void        lock();
    void        start(const Environment& environment);
    void        resume(const Environment& environment, bool retry);
    std::string finished_rows(std::string_view rows, std::span<const std::string_view> beside, bool retry);
    void        require_unmoved(const std::filesystem::path& file, int fd) const;
    void        open_files();
    void        close_files() const;
    void        remove_partial_files() const;

    std::filesystem::path   folder_, csv_;
    std::array<SideFile, 3> beside_; // samples, passes, sources
    std::vector<Column>     columns_;
    std::set<std::string>   finished_;
    int                     next_round_ = 0;
    int                     lock_fd_ = -1, csv_fd_ = -1;
};

} // namespace ssrlab
