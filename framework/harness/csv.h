// RFC 4180: fields with commas, quotes or line ends are quoted, quotes doubled, records end with CR LF.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ssrlab {

using CsvRecord = std::vector<std::string>;

std::string csv_line(const CsvRecord& fields);

/// Takes one record off the front of `text`; nothing when the rest is empty or torn (no line end outside quotes).
std::optional<CsvRecord> take_csv_record(std::string_view& text);

} // namespace ssrlab
