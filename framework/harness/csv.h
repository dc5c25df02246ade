// CSV by RFC 4180: fields with commas, quotes or line ends are quoted, quotes doubled, records end with CR LF.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace ssrlab {

using CsvRecord = std::vector<std::string>;

std::string csv_line(const CsvRecord& fields);

/// Removes one record from the front of `text`; nullopt if the rest is empty or torn (no line end outside quotes).
std::optional<CsvRecord> take_csv_record(std::string_view& text);

/// Returns the header and the records that begin with one of `ids`; a torn last record is left out.
std::string lines_of(const CsvRecord& header, std::string_view records, const std::set<std::string>& ids);

} // namespace ssrlab
