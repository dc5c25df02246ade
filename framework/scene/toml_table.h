// Reading TOML strictly: every mistake is a SpecError that names file and line.
#pragma once

#include <glm/glm.hpp>
#include <toml++/toml.h>

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace ssrlab {

/// Parses a file; throws SpecError with file:line for a syntax error, Failure when it cannot be read.
toml::table parse_toml_file(const std::filesystem::path& file);

/// One table. Asking for a key declares it; refuse_unknown_keys() then rejects all others.
class TomlTable {
public:
    TomlTable(const toml::table& table, std::string file, std::string what);

    bool                       has(const char* key) const;
    std::optional<std::string> text(const char* key);
    std::optional<bool>        flag(const char* key);
    std::optional<double>      number(const char* key, double min, double max);
    std::optional<glm::dvec3>  vector(const char* key);
    std::optional<glm::dvec3>  colour(const char* key);  // three numbers >= 0, or one for grey
    std::vector<glm::dvec3>    vectors(const char* key); // one vector or a list of them
    std::optional<glm::ivec2>  size_px(const char* key); // "1280x720"
    std::optional<size_t>      choice(const char* key, const std::vector<std::string>& names);
    std::optional<TomlTable>   table(const char* key);
    std::vector<TomlTable>     tables(const char* key); // [[key]]

    void               refuse_unknown_keys() const;
    [[noreturn]] void  fail(const std::string& message) const;                  // at the table
    [[noreturn]] void  fail(const char* key, const std::string& message) const; // at the key
    const std::string& file() const { return file_; }
    std::string        place() const; // file:line

private:
    const toml::node*         find(const char* key);
    std::optional<glm::dvec3> to_vector(const toml::node& node) const;

    const toml::table*    table_;
    std::string           file_;
    std::string           what_;
    std::set<std::string> known_;
};

} // namespace ssrlab
