#include "harness/merge_results.h"

#include "core/error.h"
#include "core/files.h"
#include "core/printable.h"
#include "harness/passes.h"
#include "harness/result_folder.h"
#include "harness/samples.h"
#include "harness/source_rows.h"

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <map>
#include <set>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

/// Files of tables whose rows begin with an id; the second is there for sequences alone.
constexpr const char* results_file = "results.csv";
constexpr const char* summary_file = "sequence_summary.csv";

struct Table {
    CsvRecord              header;
    std::vector<CsvRecord> rows;
};

/// A torn last record is left out.
Table read_table(const fs::path& file)
{
    const std::string text = read_file(file);
    std::string_view  rest = text;
    Table             table;
    if (const auto header = take_csv_record(rest)) table.header = *header;
    while (const auto record = take_csv_record(rest)) table.rows.push_back(*record);
    return table;
}

/// The rows of this file of all folders, each id once.
Table joined(const std::vector<fs::path>& folders, const char* name)
{
    Table                           all;
    std::map<std::string, fs::path> owners;
    for (const fs::path& folder : folders) {
        const fs::path file = folder / name;
        if (!fs::exists(file)) continue;
        const Table table = read_table(file);
        refuse_old_form(file, table.header);
        if (all.header.empty()) all.header = table.header;
        if (table.header != all.header)
            throw_spec_error("{}: its columns are not those of {}", short_path(file), short_path(folders.front()));
        for (const CsvRecord& row : table.rows) {
            if (row.size() != all.header.size())
                throw_spec_error("{}: damaged: the row of '{}' has {} fields, expected {}", short_path(file),
                                 row.front(), row.size(), all.header.size());
            const auto [owner, fresh] = owners.emplace(row.front(), folder);
            if (!fresh)
                throw_spec_error("{}: '{}' is in {}, too", short_path(file), row.front(), short_path(owner->second));
            all.rows.push_back(row);
        }
    }
    return all;
}

std::string text_of(const Table& table)
{
    std::string text = csv_line(table.header);
    for (const CsvRecord& row : table.rows) text += csv_line(row);
    return text;
}

nlohmann::ordered_json read_environment(const fs::path& folder)
{
    const fs::path file = folder / "environment.json";
    try {
        auto json = nlohmann::ordered_json::parse(read_file(file));
        json.at("identity").get<std::map<std::string, std::string>>();
        return json;
    } catch (const nlohmann::json::exception& error) {
        throw_spec_error("{}: damaged: {}", short_path(file), error.what());
    }
}

/// That of the first folder, with the folders' names.
std::string joined_environment(const std::vector<fs::path>& folders)
{
    using Identity                   = std::map<std::string, std::string>;
    nlohmann::ordered_json json      = read_environment(folders.front());
    const auto             reference = json.at("identity").get<Identity>();
    for (const fs::path& folder : folders) {
        const auto changed = differences(reference, read_environment(folder).at("identity").get<Identity>());
        if (!changed.empty())
            throw_spec_error("{}: not of the same experiment as {}; these differ: {}", short_path(folder),
                             short_path(folders.front()), fmt::join(changed, ", "));
        json["merged_from"].push_back(short_path(folder));
    }
    return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

/// What this file says of the runs that have a row.
std::string joined_lines(const std::vector<fs::path>& folders, const char* name, const CsvRecord& header,
                         const Table& results)
{
    std::set<std::string> ids;
    for (const CsvRecord& row : results.rows) ids.insert(row.front());
    std::string all = csv_line(header);
    for (const fs::path& folder : folders) {
        const std::string text = read_file(folder / name);
        all += lines_of(header, take_header(text, folder / name, header), ids).substr(csv_line(header).size());
    }
    return all;
}

void copy_pictures(const fs::path& from, const fs::path& to)
{
    if (!fs::is_directory(from)) return;
    fs::create_directories(to);
    for (const fs::directory_entry& entry : fs::directory_iterator(from))
        if (!entry.path().filename().string().starts_with("."))
            fs::copy_file(entry.path(), to / entry.path().filename(), fs::copy_options::overwrite_existing);
}

} // namespace

int merge_results(const fs::path& merged, const std::vector<fs::path>& folders)
{
    if (fs::exists(merged / results_file))
        throw_spec_error("{}: already there; choose another folder", short_path(merged / results_file));
    for (const fs::path& folder : folders)
        if (!fs::exists(folder / results_file))
            throw_spec_error("{}: no such file; ssrlab run writes it", short_path(folder / results_file));
    const std::string environment = joined_environment(folders);
    // Rows first: a sweep that still runs writes a run's other lines before its row.
    const Table       results = joined(folders, results_file), summaries = joined(folders, summary_file);
    const std::string samples = joined_lines(folders, "samples.csv", sample_columns(), results);
    const std::string passes  = joined_lines(folders, "passes.csv", names_of(pass_columns()), results);
    const std::string sources = joined_lines(folders, "sources.csv", names_of(source_file_columns()), results);

    fs::create_directories(merged);
    for (const fs::path& folder : folders) copy_pictures(folder / "pictures", merged / "pictures");
    write_file_atomically(merged / "environment.json", environment);
    write_file_atomically(merged / "samples.csv", samples);
    write_file_atomically(merged / "passes.csv", passes);
    write_file_atomically(merged / "sources.csv", sources);
    if (!summaries.header.empty()) write_file_atomically(merged / summary_file, text_of(summaries));
    // Last, because a results.csv promises that everything else is there.
    write_file_atomically(merged / results_file, text_of(results));
    fmt::print("{}: {} of {}\n", short_path(merged / results_file), counted(results.rows.size(), "row"),
               counted(folders.size(), "folder"));
    return 0;
}

} // namespace ssrlab
