// A folder of results: results.csv has a row for each run, written whole or not at all, samples.csv the timed frames
// behind the rows, passes.csv the passes of their frames.
#pragma once

#include "harness/record.h"

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace ssrlab {

struct SampleCounts;

/// What results came from, as written to environment.json.
struct Environment {
    std::map<std::string, std::string> identity; // must be the same when a sweep is resumed
    std::map<std::string, std::string> notes;
};

/// Names of entries that differ or that only one of the two has.
std::vector<std::string> differences(const std::map<std::string, std::string>& a,
                                     const std::map<std::string, std::string>& b);

/// SpecError if an older ssrlab wrote this results.csv: it packed the times of passes into columns.
void refuse_old_form(const std::filesystem::path& results_csv, const CsvRecord& header);

/// A results folder that is open for writing: locked against other writers until the object is gone.
class ResultFolder {
public:
    /// Fresh: creates the folder, environment.json and the header; refuses (Failure) a folder that has results.
    /// Resuming: cuts off a torn row; takes out the rows that lack samples or passes and, with `retry`, those that
    /// failed, so that these runs are tried again; takes out the samples and passes of runs without a row. SpecError
    /// when columns or identity differ, naming what does.
    ResultFolder(std::filesystem::path folder, std::vector<Column> columns, const Environment& environment, bool resume,
                 bool retry = true);
    ~ResultFolder();
    ResultFolder(const ResultFolder&)            = delete;
    ResultFolder& operator=(const ResultFolder&) = delete;

    /// The runs that have a row.
    const std::set<std::string>& finished() const { return finished_; }

    /// The rows that stand, by run id.
    std::map<std::string, Record> rows() const;

    /// Above every round in samples.csv.
    int next_round() const { return next_round_; }

    /// Writes the run's samples, its passes, then its row, each by one checked write with a sync. On failure it cuts
    /// off the torn bytes and throws a Failure that names the file: the files are always correct prefixes, and a row
    /// has its samples and passes.
    void append(const Record& row, std::string_view samples = "", std::string_view passes = "");

    /// Throws Failure when the folder's files are no longer those that were written.
    void require_unmoved() const;

    const std::filesystem::path& path() const { return folder_; }

private:
    void        lock();
    void        start(const Environment& environment);
    void        resume(const Environment& environment, bool retry);
    std::string finished_rows(std::string_view rows, const SampleCounts& samples,
                              const std::map<std::string, int64_t>& passes, bool retry);
    void        require_unmoved(const std::filesystem::path& file, int fd) const;
    void        open_files();
    void        remove_partial_files() const;

    std::filesystem::path folder_, csv_, samples_, passes_;
    std::vector<Column>   columns_;
    std::set<std::string> finished_;
    int                   next_round_ = 0;
    int                   lock_fd_ = -1, csv_fd_ = -1, samples_fd_ = -1, passes_fd_ = -1;
};

} // namespace ssrlab
