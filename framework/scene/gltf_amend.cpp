// What the parser refuses although glTF allows it: changed in the JSON before the parser sees it.
#include "scene/gltf_json.h"

#include <algorithm>

namespace ssrlab::gltf {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

/// Bytes of a buffer's own data or file; nothing where it has neither.
std::optional<uint64_t> bytes_of_uri(const Import& import, const json& buffer, const fs::path& folder,
                                     const std::string& where)
{
    if (!buffer.contains("uri")) return std::nullopt;
    const std::string uri = buffer["uri"];
    if (uri.starts_with("data:")) {
        const size_t from = uri.find(base64) + base64.size(), end = uri.find_last_not_of('=') + 1;
        return end > from ? (end - from) * 3 / 4 : 0;
    }
    std::error_code error;
    const fs::path  file = resolve_uri(folder, uri);
    if (!fs::exists(file, error)) import.fail("{}/uri: there is no file '{}'", where, uri);
    const uint64_t size = fs::is_regular_file(file, error) ? fs::file_size(file, error) : 0;
    return size > 0 && !error ? std::optional(size) : std::nullopt; // what is no file is refused when it is read
}

/// The parser takes a plus for a space, as in forms of web pages; in the path of a URI it is a plus (RFC 3986).
std::string with_escaped_plus(const std::string& uri)
{
    std::string escaped;
    for (const char c : uri) escaped += c == '+' ? std::string("%2B") : std::string(1, c);
    return escaped;
}

} // namespace

std::vector<size_t> give_indices_a_view(const Import& import, json& root)
{
    const size_t        accessors = array_of(import, root, "accessors").size();
    std::vector<size_t> given;
    if (array_of(import, root, "bufferViews").empty()) return given;
    for (const json& mesh : array_of(import, root, "meshes")) {
        if (!mesh.contains("primitives") || !mesh["primitives"].is_array()) continue;
        for (const json& primitive : mesh["primitives"]) {
            if (!primitive.is_object() || !primitive.contains("indices")) continue;
            const json& number = primitive["indices"];
            if (!number.is_number_unsigned() || number >= accessors) continue;
            json& accessor = root["accessors"][number.get<size_t>()];
            if (accessor.contains("bufferView") || !accessor.contains("sparse")) continue;
            accessor["bufferView"] = 0;
            given.push_back(number.get<size_t>());
        }
    }
    return given;
}

bool give_uris_one_form(const Import& import, json& root)
{
    constexpr std::string_view known   = "data:application/octet-stream";
    bool                       changed = false;
    for (const char* kind : {"buffers", "images"}) {
        const size_t count = array_of(import, root, kind).size();
        for (size_t i = 0; i < count; ++i) {
            const auto uri = root[kind][i].find("uri");
            if (uri == root[kind][i].end()) continue;
            const std::string text = *uri;
            if (text.starts_with("data:"))
                *uri = std::string(known) + text.substr(text.find(base64));
            else
                *uri = with_escaped_plus(text);
            changed = changed || *uri != text;
        }
    }
    return changed;
}

bool give_buffers_their_size(const Import& import, json& root, const fs::path& folder)
{
    const size_t count   = array_of(import, root, "buffers").size();
    bool         changed = false;
    for (size_t i = 0; i < count; ++i) {
        const std::string where  = fmt::format("/buffers/{}", i);
        json&             buffer = root["buffers"][i];
        const auto        size   = bytes_of_uri(import, buffer, folder, where);
        const uint64_t    said   = count_of(import, buffer, "byteLength", where, 0);
        if (!size || *size == said) continue;
        if (*size < said) import.fail("{}: expected data of {} bytes, got a size of {}", where, said, *size);
        buffer["byteLength"] = *size;
        changed              = true;
    }
    return changed;
}

} // namespace ssrlab::gltf
