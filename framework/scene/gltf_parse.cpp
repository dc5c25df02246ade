// Before the parser: what it would crash on, hang on, or read from outside the asset's folder.
#include "core/files.h"
#include "scene/gltf_json.h"

#include <algorithm>
#include <cstring>

namespace ssrlab::gltf {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

uint32_t read_u32(const std::vector<unsigned char>& bytes, size_t at)
{
    uint32_t value = 0;
    std::memcpy(&value, &bytes[at], sizeof value);
    return value;
}

bool is_binary(const std::vector<unsigned char>& bytes)
{
    return bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
}

std::string_view json_text(const Import& import, const std::vector<unsigned char>& bytes)
{
    const char* text = reinterpret_cast<const char*>(bytes.data());
    if (!is_binary(bytes)) return {text, bytes.size()};
    if (bytes.size() < 20) import.fail("truncated: no room for the GLB header");
    if (read_u32(bytes, 4) != 2) import.fail("GLB version {} is not supported, only 2", read_u32(bytes, 4));
    if (read_u32(bytes, 8) > bytes.size())
        import.fail("truncated: the GLB header says {} bytes, the file has {}", read_u32(bytes, 8), bytes.size());
    const uint64_t length = read_u32(bytes, 12);
    if (std::memcmp(&bytes[16], "JSON", 4) != 0 || 20 + length > bytes.size())
        import.fail("the first GLB chunk is no JSON, or longer than the file");
    return {text + 20, static_cast<size_t>(length)};
}

/// The parser recurses: some ten thousand brackets overflow its stack.
void check_json_depth(const Import& import, std::string_view text)
{
    int  depth     = 0;
    bool in_string = false;
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string) {
            if (c == '\\')
                ++i;
            else if (c == '"')
                in_string = false;
        } else if (c == '"') {
            in_string = true;
        } else if (c == '[' || c == '{') {
            if (++depth > max_json_depth) import.fail("JSON is nested deeper than {} levels", max_json_depth);
        } else if (c == ']' || c == '}') {
            --depth;
        }
    }
}

/// The JSON of a file's bytes.
json parse_json(const Import& import, const std::vector<unsigned char>& bytes)
{
    const std::string_view text = json_text(import, bytes);
    check_json_depth(import, text);
    try {
        json parsed = json::parse(text);
        if (!parsed.is_object()) import.fail("the JSON is no object");
        return parsed;
    } catch (const json::exception& error) {
        import.fail("broken JSON: {}", error.what());
    }
}

void check_version(const Import& import, const json& root)
{
    const auto asset = root.find("asset");
    if (asset == root.end() || !asset->is_object() || !asset->contains("version") || !(*asset)["version"].is_string())
        import.fail("/asset/version is missing: no glTF 2.0");
    const std::string version = (*asset)["version"];
    if (!version.starts_with("2.")) import.fail("glTF version {} is not supported, only 2.x", version);
}

/// Refuses URIs that lead elsewhere.
std::vector<fs::path> files_named_in(const Import& import, const json& root, const fs::path& folder)
{
    std::vector<fs::path> files;
    for (const char* kind : {"buffers", "images"}) {
        const json& items = array_of(import, root, kind);
        for (size_t i = 0; i < items.size(); ++i) {
            const auto uri = items[i].find("uri");
            if (uri == items[i].end()) continue;
            if (!uri->is_string()) import.fail("/{}/{}/uri is no text", kind, i);
            const std::string text = *uri;
            if (text.starts_with("data:")) {
                if (text.find(base64) == std::string::npos)
                    import.fail("/{}/{}/uri: expected a data URI in base64, got '{}…'", kind, i, text.substr(0, 40));
                continue;
            }
            try {
                files.push_back(resolve_uri(folder, text));
            } catch (const Failure& failure) {
                import.fail("/{}/{}/uri: {}", kind, i, failure.what());
            }
        }
    }
    return files;
}

/// The parser reads images through buffer views before anybody could check them.
void check_buffer_views(const Import& import, const json& root)
{
    const json& buffers = array_of(import, root, "buffers");
    const json& views   = array_of(import, root, "bufferViews");
    for (size_t i = 0; i < views.size(); ++i) {
        const std::string where  = fmt::format("/bufferViews/{}", i);
        const uint64_t    buffer = count_of(import, views[i], "buffer", where, ~0ULL);
        if (buffer >= buffers.size()) import.fail("{}/buffer: there is no such buffer", where);
        const uint64_t size   = count_of(import, buffers[buffer], "byteLength", fmt::format("/buffers/{}", buffer), 0);
        const uint64_t offset = count_of(import, views[i], "byteOffset", where, 0);
        const uint64_t length = count_of(import, views[i], "byteLength", where, 0);
        if (length == 0 || offset > size || length > size - offset)
            import.fail("{} reaches beyond its buffer ({} + {} of {} bytes)", where, offset, length, size);
    }
}

/// Corners that an accessor can hold; one that says more than its bytes can is refused when it is read.
uint64_t corner_count(const Import& import, const json& root, const json& accessor)
{
    const json& views = array_of(import, root, "bufferViews");
    const auto  view  = accessor.find("bufferView");
    if (view == accessor.end() || !view->is_number_unsigned() || *view >= views.size()) return 0;
    return std::min(count_of(import, accessor, "count", "/accessors", 0),
                    count_of(import, views[view->get<size_t>()], "byteLength", "/bufferViews", 0));
}

/// Before the buffers are read. Instances are counted when they are placed.
void check_triangle_count(const Import& import, const json& root)
{
    const json& accessors = array_of(import, root, "accessors");
    const auto  member    = [](const json& object, const char* key) {
        return object.is_object() && object.contains(key) ? object[key] : json();
    };
    uint64_t triangles = 0;
    for (const json& mesh : array_of(import, root, "meshes"))
        for (const json& primitive : member(mesh, "primitives")) {
            const json mode = member(primitive, "mode"), indices = member(primitive, "indices");
            const json accessor = indices.is_null() ? member(member(primitive, "attributes"), "POSITION") : indices;
            if (mode.is_number() && mode < TINYGLTF_MODE_TRIANGLES) continue; // points and lines
            if (!accessor.is_number_unsigned() || accessor >= accessors.size()) continue;
            triangles += corner_count(import, root, accessors[accessor.get<size_t>()]) / 3; // strips and fans have more
            if (triangles > max_triangles) refuse_triangles(import, triangles);
        }
}

/// The same file with other JSON.
std::vector<unsigned char> with_json(const Import& import, const std::vector<unsigned char>& bytes, std::string text)
{
    if (!is_binary(bytes)) return {text.begin(), text.end()};
    const size_t after = 20 + json_text(import, bytes).size();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::vector<unsigned char> result(bytes.begin(), bytes.begin() + 20);
    result.insert(result.end(), text.begin(), text.end());
    result.insert(result.end(), bytes.begin() + static_cast<std::ptrdiff_t>(after), bytes.end());
    const auto whole = static_cast<uint32_t>(result.size()), length = static_cast<uint32_t>(text.size());
    std::memcpy(&result[8], &whole, sizeof whole);
    std::memcpy(&result[12], &length, sizeof length);
    return result;
}

/// The folder joined with a relative path; `shown` is its name in messages.
fs::path path_inside(const fs::path& folder, const fs::path& path, const std::string& shown)
{
    if (path.empty() || path.string().find('\0') != std::string::npos || path.is_absolute())
        throw_failure("'{}' is not a relative path", shown);
    const fs::path root     = fs::weakly_canonical(folder);
    fs::path       resolved = fs::weakly_canonical(root / path); // follows links
    const fs::path inside   = resolved.lexically_relative(root);
    if (inside.empty() || *inside.begin() == "..") throw_failure("'{}' leads out of the asset's folder", shown);
    return resolved;
}

bool keep_encoded(tinygltf::Image* image, const int, std::string*, std::string*, int, int, const unsigned char* bytes,
                  int size, void*)
{
    image->image.assign(bytes, bytes + std::max(size, 0));
    return true;
}

tinygltf::FsCallbacks confined_file_access(fs::path* folder)
{
    tinygltf::FsCallbacks callbacks{};
    callbacks.FileExists = [](const std::string& name, void*) {
        std::error_code error;
        return fs::is_regular_file(name, error);
    };
    callbacks.ExpandFilePath = [](const std::string& name, void*) { return name; };
    callbacks.ReadWholeFile  = [](std::vector<unsigned char>* out, std::string* error, const std::string& name,
                                 void* data) {
        try {
            const fs::path& root = *static_cast<fs::path*>(data);
            *out = read_regular_file(path_inside(root, fs::path(name).lexically_relative(root), name), max_file_bytes);
            return true;
        } catch (const std::exception& exception) {
            if (error != nullptr) *error += exception.what();
            return false;
        }
    };
    callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
        return false;
    };
    callbacks.user_data = folder;
    return callbacks;
}

std::string one_line(std::string text)
{
    constexpr size_t longest = 300; // a data URI may be in it
    while (!text.empty() && text.back() == '\n') text.pop_back();
    if (text.size() > longest) text = text.substr(0, longest) + "…";
    std::ranges::replace(text, '\n', ' ');
    return text;
}

std::string percent_decoded(const std::string& text)
{
    std::string result;
    for (size_t i = 0; i < text.size(); ++i) {
        unsigned value = 0;
        if (text[i] == '%' && i + 2 < text.size() && std::sscanf(text.c_str() + i + 1, "%2x", &value) == 1) {
            result += static_cast<char>(value);
            i += 2;
        } else {
            result += text[i];
        }
    }
    return result;
}

} // namespace

uint64_t count_of(const Import& import, const json& object, const char* key, const std::string& where,
                  uint64_t fallback)
{
    const auto found = object.find(key);
    if (found == object.end()) return fallback;
    if (!found->is_number_unsigned()) import.fail("{}/{} must be a whole number >= 0", where, key);
    return found->get<uint64_t>();
}

void Import::warn(const std::string& text)
{
    if (said.insert(text).second)
        model.warnings.push_back(fmt::format("{}: {}", fs::path(file).filename().string(), text));
}

void refuse_triangles(const Import& import, uint64_t triangles)
{
    throw_spec_error("{}: {} triangles with all instances, at most {} can be loaded", import.file, triangles,
                     max_triangles);
}

fs::path resolve_uri(const fs::path& folder, const std::string& uri)
{
    const std::string text = percent_decoded(uri);
    if (text.find("://") != std::string::npos || text.starts_with("file:"))
        throw_failure("'{}' is not a relative path", uri);
    return path_inside(folder, text, uri);
}

std::vector<fs::path> files_named_by(const fs::path& file)
{
    Import import;
    import.file      = file.string();
    const auto bytes = read_regular_file(file, max_file_bytes);
    return files_named_in(import, parse_json(import, bytes), file.parent_path());
}

void parse_file(Import& import, const fs::path& file)
{
    import.file                             = file.string();
    fs::path                         folder = fs::weakly_canonical(file).parent_path();
    const std::vector<unsigned char> bytes  = read_regular_file(file, max_file_bytes);
    std::vector<size_t>              zeros;
    std::vector<unsigned char>       changed;
    {
        json root = parse_json(import, bytes);
        check_version(import, root);
        check_extensions(import, root);
        check_compressed_meshes(import, root);
        for (const char* kind : {"nodes", "meshes", "accessors", "materials", "textures", "scenes", "cameras"})
            array_of(import, root, kind);
        files_named_in(import, root, folder);
        check_buffer_views(import, root);
        check_triangle_count(import, root);
        zeros                  = give_indices_a_view(import, root);
        const bool other_sizes = give_buffers_their_size(import, root, folder);
        const bool other_uris  = give_uris_one_form(import, root);
        if (!zeros.empty() || other_sizes || other_uris) changed = with_json(import, bytes, root.dump());
    }
    const std::vector<unsigned char>& parsed = changed.empty() ? bytes : changed;
    tinygltf::TinyGLTF                parser;
    parser.SetImageLoader(keep_encoded, nullptr);
    parser.SetFsCallbacks(confined_file_access(&folder));
    std::string error;
    std::string warning;
    bool        ok   = false;
    const auto  size = static_cast<unsigned>(parsed.size());
    try {
        ok = is_binary(parsed)
                 ? parser.LoadBinaryFromMemory(&import.json, &error, &warning, parsed.data(), size, folder.string())
                 : parser.LoadASCIIFromString(&import.json, &error, &warning, json_text(import, parsed).data(), size,
                                              folder.string());
    } catch (const std::exception& exception) {
        error += exception.what();
    }
    if (!ok) import.fail("{}", one_line(error.empty() ? "cannot be parsed" : error));
    for (const size_t accessor : zeros) import.json.accessors[accessor].bufferView = -1;
    if (!warning.empty()) import.warn(one_line(warning));
}

} // namespace ssrlab::gltf
