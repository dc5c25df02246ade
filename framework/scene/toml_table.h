// Tables of scene files. Every mistake is a SpecError that names file and line.
#pragma once

#include "core/toml_reading.h"

#include <glm/glm.hpp>

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace ssrlab {

/// One table of a file, which must outlive it. Asking for a key declares it; refuse_unknown_keys() rejects the others.
class TomlTable {
public:
    TomlTable(const TomlFile& file, const toml::table& table, std::string what);

    bool                       has(const char* key) const;
    std::optional<std::string> text(const char* key);
    std::vector<std::string>   texts(const char* key); // a list of texts
    std::optional<bool>        flag(const char* key);
    std::optional<double>      number(const char* key, double min, double max);
    std::optional<double>      any_number(const char* key); // inf and nan, too
    std::optional<glm::dvec3>  vector(const char* key);
    std::optional<glm::dvec3>  colour(const char* key);  // three numbers >= 0, or one for grey
    std::vector<glm::dvec3>    vectors(const char* key); // one vector or a list of them
    std::optional<glm::ivec2>  size_px(const char* key); // "1280x720"
    std::optional<size_t>      choice(const char* key, const std::vector<std::string>& names);
    std::optional<TomlTable>   table(const char* key);
    std::vector<TomlTable>     tables(const char* key); // [[key]]

    void              refuse_unknown_keys() const;
    [[noreturn]] void fail(const std::string& message) const;                  // at the table
    [[noreturn]] void fail(const char* key, const std::string& message) const; // at the key
    std::string       place() const;                                           // file:line
    std::string       place(const char* key) const;                            // of the key, or of the table without it

private:
    const toml::node* find(const char* key);
    /// "must be EXPECTED, got" what stands there.
    [[noreturn]] void refuse(const char* key, const std::string& expected) const;

    const TomlFile*       file_;
    const toml::table*    table_;
    std::string           what_;
    std::set<std::string> known_;
};

} // namespace ssrlab
