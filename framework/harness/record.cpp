#include "harness/record.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace ssrlab {
namespace {

/// Empty unless all of the text is a number.
template <typename Number> std::optional<Number> read_number(const std::string& text)
{
    Number     number = 0;
    const auto end    = text.data() + text.size();
    const auto read   = std::from_chars(text.data(), end, number);
    return read.ec == std::errc() && read.ptr == end ? std::optional(number) : std::nullopt;
}

std::string text_of(const Value& value, ColumnType type)
{
    if (const auto* words = std::get_if<std::string>(&value)) return *words;
    if (const auto* whole = std::get_if<int64_t>(&value)) return std::to_string(*whole);
    const double number = std::get<double>(value);
    return type == ColumnType::measure ? fmt::format("{:.6g}", number) : fmt::format("{}", number);
}

Value value_of(const std::string& text, ColumnType type)
{
    if (type == ColumnType::words) return text;
    if (type == ColumnType::whole)
        if (const auto whole = read_number<int64_t>(text)) return *whole;
    if (const auto number = read_number<double>(text)) return *number;
    return text;
}

} // namespace

std::vector<std::string> names_of(std::span<const Column> columns)
{
    std::vector<std::string> names;
    for (const Column& column : columns) names.push_back(column.name);
    return names;
}

void put(Record& record, const std::string& column, double value)
{
    if (!std::isnan(value)) record[column] = value;
}

std::optional<double> number_of(const Record& record, const std::string& column)
{
    const auto found = record.find(column);
    if (found == record.end()) return std::nullopt;
    if (const auto* whole = std::get_if<int64_t>(&found->second)) return static_cast<double>(*whole);
    const auto* number = std::get_if<double>(&found->second);
    return number != nullptr ? std::optional(*number) : std::nullopt;
}

std::string words_of(const Record& record, const std::string& column)
{
    const auto  found = record.find(column);
    const auto* words = found == record.end() ? nullptr : std::get_if<std::string>(&found->second);
    return words != nullptr ? *words : "";
}

CsvRecord fields_of(const Record& record, std::span<const Column> columns)
{
    CsvRecord fields;
    for (const Column& column : columns) {
        const auto found = record.find(column.name);
        fields.push_back(found == record.end() ? "" : text_of(found->second, column.type));
    }
    return fields;
}

Record record_of(const CsvRecord& fields, std::span<const Column> columns)
{
    Record record;
    for (size_t i = 0; i < columns.size(); ++i)
        if (!fields.at(i).empty()) record[columns[i].name] = value_of(fields.at(i), columns[i].type);
    return record;
}

} // namespace ssrlab
