// results.csv: one row per run, each written whole or not at all; samples.csv: the timed frames behind the rows.
#pragma once

#include "harness/csv.h"

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace ssrlab {

/// Text by column name; a column without an entry stays empty.
using Row = std::map<std::string, std::string>;

/// What results came from, as written to environment.json.
struct Environment {
    std::map<std::string, std::string> identity; // must be the same when a sweep is resumed
    std::map<std::string, std::string> notes;
};

/// Names of entries that differ or that only one of the two has.
std::vector<std::string> differences(const std::map<std::string, std::string>& a,
                                     const std::map<std::string, std::string>& b);

/// A results folder that is open for writing: locked against other writers until the object is gone.
class ResultFolder {
public:
    /// Fresh: creates the folder, environment.json and the header; refuses (Failure) a folder that has results.
    /// Resuming: cuts off a torn row, takes out the rows that lack samples and, with `retry`, those that failed, so that these runs
    /// are tried again, and the samples of runs without a row; refuses (SpecError) when columns or identity differ, naming what does.
    ResultFolder(std::filesystem::path folder, std::vector<std::string> columns, const Environment& environment,
                 bool resume, bool retry = true);
    ~ResultFolder();
    ResultFolder(const ResultFolder&)            = delete;
    ResultFolder& operator=(const ResultFolder&) = delete;

    /// The runs that have a row.
    const std::set<std::string>& finished() const { return finished_; }

    /// The rows that stand, by run id, as results.csv has them.
    std::map<std::string, Row> rows() const;

    /// Above every round in samples.csv.
    int next_round() const { return next_round_; }

    /// One checked write of the run's samples, then one of its row, each with a sync. On failure the torn bytes are cut off
    /// again and a Failure names the file: what is on disk is always a correct prefix, and a row's samples are there before it.
    void append(const Row& row, std::string_view samples = "");

    /// Throws Failure when the folder's files are no longer those that were written.
    void require_unmoved() const;

    const std::filesystem::path& path() const { return folder_; }

private:
    void        lock();
    void        start(const Environment& environment);
    void        resume(const Environment& environment, bool retry);
    std::string finished_rows(std::string_view rows, const std::map<std::string, int>& frames, bool retry);
    void        require_unmoved(const std::filesystem::path& file, int fd) const;
    void        open_files();
    void        remove_partial_files() const;

    std::filesystem::path    folder_, csv_, samples_;
    std::vector<std::string> columns_;
    std::set<std::string>    finished_;
    int                      next_round_ = 0;
    int                      lock_fd_ = -1, csv_fd_ = -1, samples_fd_ = -1;
};

} // namespace ssrlab
