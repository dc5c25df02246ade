#include "harness/csv.h"

namespace ssrlab {

std::string csv_line(const CsvRecord& fields)
{
    std::string line;
    for (const std::string& field : fields) {
        if (!line.empty() || &field != &fields.front()) line += ',';
        if (field.find_first_of(",\"\r\n") == std::string::npos) {
            line += field;
            continue;
        }
        line += '"';
        for (const char c : field) line += c == '"' ? std::string(2, c) : std::string(1, c);
        line += '"';
    }
    return line + "\r\n";
}

std::optional<CsvRecord> take_csv_record(std::string_view& text)
{
    CsvRecord record(1);
    bool      quoted = false;
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"') {
            const bool doubled = quoted && i + 1 < text.size() && text[i + 1] == '"';
            if (doubled)
                record.back() += text[++i];
            else
                quoted = !quoted;
        } else if (!quoted && c == ',') {
            record.emplace_back();
        } else if (!quoted && c == '\n') {
            text.remove_prefix(i + 1);
            return record;
        } else if (quoted || c != '\r') {
            record.back() += c;
        }
    }
    return std::nullopt;
}

std::string lines_of(const CsvRecord& header, std::string_view records, const std::set<std::string>& ids)
{
    std::string kept = csv_line(header);
    while (const auto record = take_csv_record(records))
        if (ids.contains(record->front())) kept += csv_line(*record);
    return kept;
}

} // namespace ssrlab
