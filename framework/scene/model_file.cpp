#include "scene/model_file.h"

#include "core/error.h"
#include "core/files.h"
#include "scene/load_scene.h"

#include <assimp/config.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/material.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fcntl.h>
#include <glm/gtc/color_space.hpp>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <sstream>
#include <type_traits>

namespace ssrlab {
namespace fs = std::filesystem;
namespace {

constexpr uint64_t max_file_bytes = 2ULL << 30;
// Of a processor's time; a megabyte takes a twentieth of a second.
constexpr uint64_t least_time_s = 5, file_bytes_per_s = 256 << 10;

// ---- Between the processes: values as their bytes, lists behind their length.
struct Writer {
    std::string bytes;

    template <typename T> void value(const T& item)
    {
        static_assert(std::is_standard_layout_v<T>);
        bytes.append(reinterpret_cast<const char*>(&item), sizeof item);
    }
    template <typename List> void list(const List& items)
    {
        value(uint64_t(items.size()));
        bytes.append(reinterpret_cast<const char*>(items.data()), items.size() * sizeof items[0]);
    }
};

struct Reader {
    std::string_view bytes;

    void take(void* to, size_t count)
    {
        if (count > bytes.size()) throw_failure("what assimp made of it is cut");
        std::memcpy(to, bytes.data(), count);
        bytes.remove_prefix(count);
    }
    template <typename T> void    value(T& item) { take(&item, sizeof item); }
    template <typename List> void list(List& items)
    {
        uint64_t count = 0;
        value(count);
        if (count > bytes.size() / sizeof items[0]) throw_failure("what assimp made of it is cut");
        items.resize(count);
        if (count > 0) take(items.data(), count * sizeof items[0]);
    }
};

/// The same order both ways.
template <typename Stream, typename Item> void pass_material(Stream& stream, Item& material)
{
    stream.list(material.name);
    stream.list(material.texture);
    stream.list(material.other_maps);
    stream.value(material.diffuse);
    stream.value(material.specular);
    stream.value(material.emissive);
    stream.value(material.exponent);
    stream.value(material.opacity);
    stream.value(material.metallic);
    stream.value(material.roughness);
    stream.value(material.is_default);
}

template <typename Stream, typename Item> void pass_mesh(Stream& stream, Item& mesh)
{
    stream.list(mesh.name);
    stream.value(mesh.material);
    stream.value(mesh.has_normals);
    stream.value(mesh.has_colours);
    stream.list(mesh.positions_ws);
    stream.list(mesh.vertices);
    stream.list(mesh.indices);
}

// ---- The process that reads
/// assimp 5.2.5 skips lines of OBJ that are indented, and vertices that have a coordinate such as '.5'; faces then name
/// others. It refuses comments behind the numbers of a line. Without indents and such comments, and with '0.5'.
std::vector<unsigned char> as_assimp_reads_it(const std::vector<unsigned char>& obj)
{
    std::vector<unsigned char> text;
    text.reserve(obj.size() + obj.size() / 8);
    const auto at       = [&](size_t i) { return i < obj.size() ? static_cast<char>(obj[i]) : '\n'; };
    const auto is_space = [](char c) { return c == ' ' || c == '\t'; };
    bool       start = true, numbers = false, vertex = false; // of a line; in a line of numbers; in v, vn or vt
    bool       comment = false;
    for (size_t i = 0; i < obj.size(); ++i) {
        if (start && is_space(at(i))) continue;
        if (start) {
            vertex  = at(i) == 'v';
            numbers = vertex || ((at(i) == 'f' || at(i) == 'l' || at(i) == 'p') && is_space(at(i + 1)));
        }
        comment             = at(i) != '\n' && (comment || (numbers && at(i) == '#')); // not in names
        const size_t before = i - (i > 0 && at(i - 1) == '\r' ? 1 : 0);
        start               = at(i) == '\n' && !(before > 0 && at(before - 1) == '\\'); // a backslash: the line goes on
        if (comment) continue;
        const bool begins =
            i > 0 && (is_space(at(i - 1)) || (i > 1 && (at(i - 1) == '-' || at(i - 1) == '+') && is_space(at(i - 2))));
        if (vertex && begins && at(i) == '.' && at(i + 1) >= '0' && at(i + 1) <= '9') text.push_back('0');
        text.push_back(obj[i]);
    }
    return text;
}

/// assimp skips where a texture of a material file of OBJ lies.
void warn_of_placed_textures(const std::vector<unsigned char>& mtl, const std::string& name,
                             std::vector<std::string>& warnings)
{
    std::istringstream text(std::string(mtl.begin(), mtl.end()));
    int                number = 0;
    for (std::string line; std::getline(text, line);) {
        ++number;
        const auto has = [&](const char* option) { return line.find(option) != std::string::npos; };
        if (has("map_Kd ") && (has(" -s ") || has(" -o ") || has(" -t ")))
            warnings.push_back(fmt::format("{}:{}: a texture's scale, offset and turbulence (-s, -o, -t) are not "
                                           "supported and left out",
                                           name, number));
    }
}

/// A pipe beside the model would be waited for.
struct RegularFiles : Assimp::DefaultIOSystem {
    explicit RegularFiles(fs::path model) : model_(std::move(model)) {}

    bool Exists(const char* file) const override // assimp's own opens it
    {
        std::error_code error;
        return fs::is_regular_file(file, error);
    }
    Assimp::IOStream* Open(const char* file, const char* mode) override
    {
        const bool is_obj = lower_extension(model_) == ".obj";
        if (is_obj) note_materials(file);
        if (!Exists(file)) return nullptr;
        if (!is_obj) return DefaultIOSystem::Open(file, mode);
        std::vector<unsigned char> text     = read_regular_file(file, max_file_bytes);
        const bool                 is_model = lower_extension(file) == ".obj"; // and no file of materials
        if (is_model)
            text = as_assimp_reads_it(text);
        else
            warn_of_placed_textures(text, name_of(file), warnings);
        auto* buffer = new uint8_t[text.size()]; // which the stream deletes
        std::ranges::copy(text, buffer);
        return new Assimp::MemoryIOStream(buffer, text.size(), true);
    }

    std::vector<std::string> warnings;

private:
    std::string name_of(const fs::path& file) const { return file.lexically_relative(model_.parent_path()).string(); }

    /// Where a file of materials is missing, assimp tries the one that has the model's name, and says nothing.
    void note_materials(const fs::path& file)
    {
        const bool is_second_try = missing_ && file == fs::path(model_).replace_extension(".mtl");
        if (is_second_try && Exists(file.c_str())) warnings.pop_back();
        missing_ = !is_second_try && !Exists(file.c_str());
        if (missing_)
            warnings.push_back(fmt::format("there is no material file '{}': its materials are grey", name_of(file)));
    }

    fs::path model_;
    bool     missing_ = false; // the last file that was asked for
};

/// Of what the material has pictures besides its diffuse colour, as far as a picture would differ without them.
std::string other_maps_of(const aiMaterial& source, const std::string& diffuse)
{
    constexpr std::pair<aiTextureType, const char*> kinds[] = {
        {aiTextureType_OPACITY, "opacity"},    {aiTextureType_NORMALS, "normals"},
        {aiTextureType_HEIGHT, "bump"},        {aiTextureType_DISPLACEMENT, "displacement"},
        {aiTextureType_EMISSIVE, "emission"},  {aiTextureType_SPECULAR, "specular colour"},
        {aiTextureType_SHININESS, "exponent"}, {aiTextureType_DIFFUSE_ROUGHNESS, "roughness"},
        {aiTextureType_METALNESS, "metallic"}, {aiTextureType_REFLECTION, "reflection"}};
    std::string names;
    for (const auto& [kind, name] : kinds) {
        aiString file;
        if (source.GetTexture(kind, 0, &file) != aiReturn_SUCCESS) continue;
        if (kind == aiTextureType_OPACITY && file.C_Str() == diffuse) continue; // its alpha is used
        names += (names.empty() ? "" : ", ") + std::string(name);
    }
    return names;
}

FileMaterial convert_material(const aiMaterial& source)
{
    FileMaterial material;
    const auto   colour = [&](const char* key, unsigned type, unsigned index, glm::vec3& value) {
        aiColor3D found;
        if (source.Get(key, type, index, found) == aiReturn_SUCCESS) value = {found.r, found.g, found.b};
    };
    aiString text;
    if (source.Get(AI_MATKEY_NAME, text) == aiReturn_SUCCESS) material.name = text.C_Str();
    if (source.GetTexture(aiTextureType_DIFFUSE, 0, &text) == aiReturn_SUCCESS) material.texture = text.C_Str();
    colour(AI_MATKEY_COLOR_DIFFUSE, material.diffuse);
    colour(AI_MATKEY_COLOR_SPECULAR, material.specular);
    colour(AI_MATKEY_COLOR_EMISSIVE, material.emissive);
    source.Get(AI_MATKEY_SHININESS, material.exponent);
    source.Get(AI_MATKEY_OPACITY, material.opacity);
    source.Get(AI_MATKEY_METALLIC_FACTOR, material.metallic);
    source.Get(AI_MATKEY_ROUGHNESS_FACTOR, material.roughness);
    material.is_default = material.name == AI_DEFAULT_MATERIAL_NAME;
    material.other_maps = other_maps_of(source, material.texture);
    return material;
}

FileMesh convert_mesh(const aiMesh& source)
{
    FileMesh mesh;
    mesh.name        = source.mName.C_Str();
    mesh.material    = source.mMaterialIndex;
    mesh.has_normals = source.HasNormals();
    mesh.has_colours = source.HasVertexColors(0);
    for (unsigned i = 0; i < source.mNumVertices; ++i) {
        Vertex vertex{};
        vertex.normal_ws = {0, 1, 0};
        vertex.colour    = glm::vec4(1);
        if (mesh.has_normals) vertex.normal_ws = {source.mNormals[i].x, source.mNormals[i].y, source.mNormals[i].z};
        if (source.HasTextureCoords(0))
            // OBJ counts v from the bottom of the image.
            vertex.uv0 = vertex.uv1 = {source.mTextureCoords[0][i].x, 1 - source.mTextureCoords[0][i].y};
        if (mesh.has_colours) { // stored as scanners and paint programs show them: in sRGB
            const aiColor4D& c = source.mColors[0][i];
            vertex.colour      = glm::vec4(glm::convertSRGBToLinear(glm::vec3(c.r, c.g, c.b)), c.a);
        }
        mesh.positions_ws.emplace_back(source.mVertices[i].x, source.mVertices[i].y, source.mVertices[i].z);
        mesh.vertices.push_back(vertex);
    }
    for (unsigned i = 0; i < source.mNumFaces; ++i) {
        const aiFace& face = source.mFaces[i];
        if (face.mNumIndices == 3) // others are points and lines
            mesh.indices.insert(mesh.indices.end(), face.mIndices, face.mIndices + 3);
    }
    return mesh;
}

glm::dmat4 convert_matrix(const aiMatrix4x4& m)
{
    return {{m.a1, m.b1, m.c1, m.d1}, {m.a2, m.b2, m.c2, m.d2}, {m.a3, m.b3, m.c3, m.d3}, {m.a4, m.b4, m.c4, m.d4}};
}

std::vector<FileMesh> placed_meshes(const aiScene& scene)
{
    std::vector<FileMesh>                             meshes;
    std::vector<std::pair<const aiNode*, glm::dmat4>> pending{{scene.mRootNode, glm::dmat4(1)}};
    while (!pending.empty()) {
        const auto [node, parent] = pending.back();
        const glm::dmat4 to_world = parent * convert_matrix(node->mTransformation);
        pending.pop_back();
        for (unsigned i = 0; i < node->mNumMeshes; ++i) {
            meshes.push_back(convert_mesh(*scene.mMeshes[node->mMeshes[i]]));
            transform(meshes.back(), to_world);
        }
        for (unsigned i = 0; i < node->mNumChildren; ++i) pending.emplace_back(node->mChildren[i], to_world);
    }
    return meshes;
}

/// An error's text, empty if there is none, and the model.
std::string read_here(const fs::path& file)
{
    Writer           writer;
    Assimp::Importer importer;
    auto*            files = new RegularFiles(file); // which the importer deletes
    importer.SetIOHandler(files);
    importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_LIGHTS | aiComponent_CAMERAS);
    // Never aiProcess_JoinIdenticalVertices: version 5.2.5 crashes in it on real files.
    const aiScene* scene = importer.ReadFile(file.string(), aiProcess_Triangulate | aiProcess_RemoveComponent);
    if (scene == nullptr || scene->mRootNode == nullptr) {
        const std::string error = importer.GetErrorString();
        writer.list(error.empty() ? "no scene in it" : error);
        return writer.bytes;
    }
    writer.list(std::string());
    writer.value(uint64_t(scene->mNumMaterials));
    for (unsigned i = 0; i < scene->mNumMaterials; ++i) {
        const FileMaterial material = convert_material(*scene->mMaterials[i]);
        pass_material(writer, material);
    }
    const std::vector<FileMesh> meshes = placed_meshes(*scene);
    writer.value(uint64_t(meshes.size()));
    for (const FileMesh& mesh : meshes) pass_mesh(writer, mesh);
    writer.value(uint64_t(files->warnings.size()));
    for (const std::string& warning : files->warnings) writer.list(warning);
    return writer.bytes;
}

[[noreturn]] void be_the_reader(const fs::path& file, uint64_t time_s, int to)
{
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGXCPU, SIGALRM}) std::signal(signal, SIG_DFL);
    const rlimit time{time_s, time_s + 1}, no_core{0, 0};
    ::setrlimit(RLIMIT_CPU, &time);
    ::alarm(static_cast<unsigned>(10 * time_s)); // for what waits and takes no time
    ::setrlimit(RLIMIT_CORE, &no_core);
    // What assimp says before it aborts is for its authors.
    if (const int nothing = ::open("/dev/null", O_WRONLY | O_CLOEXEC); nothing >= 0) ::dup2(nothing, STDERR_FILENO);
    bool done = false;
    try {
        done = write_fully(to, read_here(file));
    } catch (const std::exception& error) {
        Writer writer;
        writer.list(std::string(error.what()));
        done = write_fully(to, writer.bytes);
    }
    ::_exit(done ? 0 : 1); // what the parent has opened stays its own
}

// ---- The process that asks
std::string read_elsewhere(const fs::path& file, uint64_t time_s)
{
    int ends[2] = {-1, -1};
    if (::pipe2(ends, O_CLOEXEC) != 0) throw_failure("no pipe to another process: {}", std::strerror(errno));
    const pid_t reader = ::fork();
    if (reader == 0) be_the_reader(file, time_s, ends[1]);
    ::close(ends[1]);
    std::string bytes;
    if (reader > 0) bytes = read_to_end(ends[0]);
    ::close(ends[0]);
    if (reader < 0) throw_failure("no process to read it: {}", std::strerror(errno));
    int status = 0;
    while (::waitpid(reader, &status, 0) < 0 && errno == EINTR) {}
    const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (signal == SIGXCPU || signal == SIGALRM) throw_failure("assimp took more than {} s", time_s);
    if (signal != 0) throw_failure("assimp fell over it (signal {}, {})", signal, ::strsignal(signal));
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw_failure("assimp ended without an answer");
    return bytes;
}

FileModel to_model(Reader reader)
{
    std::string error;
    reader.list(error);
    if (!error.empty()) throw_failure("{}", error);
    FileModel model;
    uint64_t  count = 0;
    reader.value(count);
    for (uint64_t i = 0; i < count; ++i) pass_material(reader, model.materials.emplace_back());
    reader.value(count);
    for (uint64_t i = 0; i < count; ++i) {
        FileMesh& mesh = model.meshes.emplace_back();
        pass_mesh(reader, mesh);
        if (mesh.material >= model.materials.size()) throw_failure("there is no material {}", mesh.material);
        if (mesh.vertices.size() != mesh.positions_ws.size() ||
            std::ranges::any_of(mesh.indices, [&](uint32_t index) { return index >= mesh.vertices.size(); }))
            throw_failure("vertex index out of range in mesh '{}'", mesh.name);
    }
    reader.value(count);
    for (uint64_t i = 0; i < count; ++i) reader.list(model.warnings.emplace_back());
    return model;
}

} // namespace

FileModel read_model_file(const fs::path& file)
{
    const uint64_t size = regular_file_bytes(file, max_file_bytes); // a clear message, before assimp's
    try {
        return to_model({read_elsewhere(file, least_time_s + size / file_bytes_per_s)});
    } catch (const Failure& failure) {
        throw_failure("{}: cannot be read: {}", file.string(), failure.what());
    }
}

} // namespace ssrlab
