// A row of results.csv: typed values by column. Numbers become text only where a file is written.
#pragma once

#include "harness/csv.h"

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace ssrlab {

using Value = std::variant<std::string, int64_t, double>;

/// Values by column name. An unknown value has no entry, and an empty field.
using Record = std::map<std::string, Value>;

/// The type of a column, and how results.csv writes its numbers.
enum class ColumnType : uint8_t {
    measure, // a number with six significant digits
    whole,
    setting, // words, or a number as the shortest text that reads back as the same
    words,
};

struct Column {
    std::string name, meaning;
    ColumnType  type = ColumnType::measure;
};

std::vector<std::string> names_of(std::span<const Column> columns);

/// Adds a number unless it is NaN.
void put(Record& record, const std::string& column, double value);

/// Returns the number in a column; nullopt if there is none.
std::optional<double> number_of(const Record& record, const std::string& column);
/// Returns the text in a column; empty if there is none.
std::string words_of(const Record& record, const std::string& column);

/// Returns the fields of a record in the order of the columns.
CsvRecord fields_of(const Record& record, std::span<const Column> columns);
/// Returns the record with these fields, one per column.
Record record_of(const CsvRecord& fields, std::span<const Column> columns);

} // namespace ssrlab
