#include "gpu/shader.h"

#include "core/error.h"
#include "core/files.h"
#include "gpu/disk_cache.h"
#include "gpu/glslang_process.h"
#include "gpu/shader_errors.h"
#include "gpu/shader_includes.h"
#include "gpu/spirv.h"
#include "gpu/vulkan.h"

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <sys/stat.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <iterator>
#include <span>
#include <sstream>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

EShLanguage language_of(ShaderStage stage)
{
    switch (stage) {
    case ShaderStage::vertex: return EShLangVertex;
    case ShaderStage::fragment: return EShLangFragment;
    case ShaderStage::compute: return EShLangCompute;
    }
    return EShLangCompute;
}

void collect_bindings(const glslang::TProgram& program, Shader& shader)
{
    for (int i = 0; i < program.getNumUniformBlocks(); ++i) {
        const auto& block = program.getUniformBlock(i);
        if (block.getBinding() >= 0 && !block.getType()->getQualifier().isPushConstant())
            shader.bindings[block.name] = {static_cast<uint32_t>(block.getBinding()), BindingType::uniform_buffer};
    }
    for (int i = 0; i < program.getNumBufferBlocks(); ++i) {
        const auto& block           = program.getBufferBlock(i);
        shader.bindings[block.name] = {static_cast<uint32_t>(block.getBinding()), BindingType::storage_buffer};
    }
    for (int i = 0; i < program.getNumUniformVariables(); ++i) {
        const auto& variable = program.getUniform(i);
        if (variable.getType()->getBasicType() != glslang::EbtSampler || variable.getBinding() < 0) continue;
        if (variable.getType()->getQualifier().hasSet() && variable.getType()->getQualifier().layoutSet != 0) continue;
        const glslang::TSampler& sampler = variable.getType()->getSampler();
        shader.bindings[variable.name]   = {static_cast<uint32_t>(variable.getBinding()),
                                          sampler.isBuffer()  ? BindingType::texel_buffer
                                            : sampler.isImage() ? BindingType::storage_image
                                                                : BindingType::sampled_image};
    }
}

using KnownShaders = GpuImpl::KnownShaders;

void look_again(KnownShaders& known)
{
    known.below.clear();
    known.states.clear();
}

const std::vector<fs::path>& files_below(KnownShaders& shaders, const fs::path& folder)
{
    auto& below = shaders.below;
    if (const auto known = below.find(folder.native()); known != below.end()) return known->second;
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) files.push_back(entry.path());
    return below.emplace(folder.native(), std::move(files)).first->second;
}

/// All files that the compiler may read for this source.
std::vector<std::filesystem::path> files_read(KnownShaders& shaders, const ShaderSource& source)
{
    std::vector<std::filesystem::path> files = {shader_folder() / source.file}; // a technique's own lies elsewhere
    for (const auto& [name, path] : source.include_files) files.push_back(path);
    std::vector<fs::path> folders = {shader_folder()};
    if (!source.include_folders.empty()) folders.push_back(technique_folder());
    const auto is_listed = [&](const fs::path& folder) { return lies_in(folder, technique_folder()); };
    std::ranges::copy_if(source.include_folders, std::back_inserter(folders), std::not_fn(is_listed));
    for (const fs::path& folder : folders) std::ranges::copy(files_below(shaders, folder), std::back_inserter(files));
    return files;
}

/// What is in a source and, of each file that the compiler may read for it, its name and `of_file` of it.
template <typename OfFile>
std::string key_of(const ShaderSource& source, std::span<const std::filesystem::path> files, const OfFile& of_file)
{
    std::string key = std::to_string(static_cast<int>(source.stage));
    const auto  add = [&](std::string_view name, std::string_view text) {
        key.append(name).append(1, '=').append(text).append(1, '\0');
    };
    for (const auto& [name, value] : source.defines) add(name, value);
    for (const auto& [name, text] : source.include_texts) add(name, text);
    for (const std::filesystem::path& path : files) add(path.native(), of_file(path));
    return key;
}

/// When a file was written, and its bytes: asked for each pass of each frame, without opening it.
const std::string& state_of(KnownShaders& shaders, const std::filesystem::path& path)
{
    auto& states = shaders.states;
    if (const auto known = states.find(path.native()); known != states.end()) return known->second;
    struct stat state = {};
    if (stat(path.c_str(), &state) != 0) throw_spec_error("{}: cannot be read", path.string());
    std::string text = fmt::format("{} {} {}", state.st_mtim.tv_sec, state.st_mtim.tv_nsec, state.st_size);
    return states.emplace(path.native(), std::move(text)).first->second;
}

/// The compiler declares every specialization constant that it read, used or not. A number that happens to equal a constant's id
/// counts as a use, too.
std::set<uint32_t> constants_used(std::span<const uint32_t> spirv)
{
    constexpr uint32_t           name = 5, decorate = 71, decoration_spec_id = 1; // SPIR-V 1.6, section 3
    std::map<uint32_t, uint32_t> constant_of;                                     // result id -> constant_id
    std::set<uint32_t>           used;
    for_each_instruction(spirv, [&](std::span<const uint32_t> words) {
        const uint32_t opcode = opcode_of(words);
        if (opcode == decorate && words[2] == decoration_spec_id) constant_of[words[1]] = words[3];
        const bool defines = opcode >= 48 && opcode <= 50; // OpSpecConstantTrue, OpSpecConstantFalse, OpSpecConstant
        if (opcode == name || opcode == decorate || defines) return;
        for (const uint32_t word : words.subspan(1))
            if (const auto found = constant_of.find(word); found != constant_of.end()) used.insert(found->second);
    });
    return used;
}

/// Marks which bindings the code reads and writes: loads and stores through pointers and images, followed to their variables.
void mark_uses(Shader& shader)
{
    // SPIR-V 1.6, section 3
    enum : uint32_t { binding = 33 }; // a decoration
    enum : uint32_t {
        decorate         = 71,
        texel_pointer    = 60,
        load             = 61,
        store            = 62,
        access           = 65,
        access_in_bounds = 66,
        copy             = 83,
        image_fetch      = 95,
        image_read       = 98,
        image_write      = 99,
        atomic_load      = 227,
        atomic_store     = 228,
        last_atomic      = 242
    };
    std::map<uint32_t, ShaderBinding*> of; // result id -> what it points into
    const auto                         find = [&](uint32_t id) {
        const auto found = of.find(id);
        return found == of.end() ? nullptr : found->second;
    };
    const auto reads = [&](uint32_t id) {
        if (ShaderBinding* used = find(id)) used->reads = true;
    };
    const auto writes = [&](uint32_t id) {
        if (ShaderBinding* used = find(id)) used->writes = true;
    };
    for_each_instruction(shader.spirv, [&](std::span<const uint32_t> words) {
        const uint32_t opcode = opcode_of(words);
        if (opcode == decorate && words[2] == binding) {
            for (auto& [name, declared] : shader.bindings)
                if (declared.binding == words[3]) of[words[1]] = &declared;
        } else if (opcode == texel_pointer || opcode == load || opcode == access || opcode == access_in_bounds ||
                   opcode == copy) {
            if (ShaderBinding* used = find(words[3])) of[words[2]] = used;
            if (opcode == load && find(words[3]) != nullptr && find(words[3])->type == BindingType::storage_buffer)
                reads(words[3]);
        } else if (opcode == store || opcode == image_write || opcode == atomic_store)
            writes(words[1]);
        else if (opcode == image_fetch || opcode == image_read || opcode == atomic_load)
            reads(words[3]);
        else if (opcode > atomic_store && opcode <= last_atomic) {
            reads(words[3]);
            writes(words[3]);
        }
    });
}

} // namespace

fs::path shader_folder() { return data_root() / "shaders"; }
fs::path technique_folder() { return data_root() / "techniques"; }

void add_device_defines(const Gpu& gpu, ShaderSource& source)
{
    if (gpu.info.plain_buffers) source.defines.emplace("PLAIN_BUFFERS", "1");
    source.defines.emplace("GROUP_LANES", std::to_string(gpu.info.lanes));
}

std::string preamble_of(const ShaderSource& source)
{
    std::string preamble =
        "#extension GL_GOOGLE_include_directive : require\n#extension GL_GOOGLE_cpp_style_line_directive : require\n"
        "#extension GL_EXT_scalar_block_layout : require\n"
        "#define SHARED_FUNCTION\n"; // of headers that C++ includes, too
    for (const auto& [name, value] : source.defines) preamble += fmt::format("#define {} {}\n", name, value);
    return preamble;
}

namespace {
Shader compile(const ShaderSource& source, ShaderIncluder& includer)
{
    start_glslang();
    const std::filesystem::path path     = shader_folder() / source.file;
    const std::string           text     = includer.read_main_file();
    const std::string           shown    = path.string();
    const bool                  is_hlsl  = path.extension() == ".hlsl"; // an export's
    const std::string           preamble = is_hlsl ? "" : preamble_of(source);

    const EShLanguage language = language_of(source.stage);
    glslang::TShader  stage(language);
    const char*       strings[] = {text.c_str()};
    const char*       names[]   = {shown.c_str()};
    const int         lengths[] = {static_cast<int>(text.size())};
    stage.setStringsWithLengthsAndNames(strings, lengths, names, 1);
    stage.setPreamble(preamble.c_str());
    target_vulkan(stage, is_hlsl ? glslang::EShSourceHlsl : glslang::EShSourceGlsl, language);
    stage.setEntryPoint("main");
    // Cascading: it goes on after the first error.
    const auto messages = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules | EShMsgCascadingErrors |
                                                   (is_hlsl ? EShMsgReadHlsl | EShMsgHlslLegalization : 0));
    if (!stage.parse(GetDefaultResources(), 460, ECoreProfile, false, false, messages, includer))
        throw SpecError(shader_errors_in(stage.getInfoLog(), source, includer.files()));
    glslang::TProgram program;
    program.addShader(&stage);
    if (!program.link(messages))
        throw_spec_error("{}: {}", shown, shader_errors_in(program.getInfoLog(), source, includer.files()));
    program.buildReflection(EShReflectionSeparateBuffers);

    Shader shader;
    shader.name  = shown;
    shader.stage = source.stage;
    collect_bindings(program, shader);
    glslang::SpvOptions options;
    options.disableOptimizer = true;
    glslang::GlslangToSpv(*program.getIntermediate(language), shader.spirv, &options);
    return shader;
}

/// "NAME BINDING TYPE\n" for each binding, an empty line, the words.
std::string to_bytes(const Shader& shader)
{
    std::string bytes;
    for (const auto& [name, binding] : shader.bindings)
        bytes += fmt::format("{} {} {}\n", name, binding.binding, static_cast<int>(binding.type));
    bytes += '\n';
    return bytes.append(reinterpret_cast<const char*>(shader.spirv.data()), shader.spirv.size() * sizeof(uint32_t));
}

Shader from_bytes(const std::string& bytes, const ShaderSource& source)
{
    Shader shader{(shader_folder() / source.file).string(), source.stage, {}, {}, {}};
    size_t begin = 0;
    for (size_t end = bytes.find('\n'); end != begin; begin = end + 1, end = bytes.find('\n', begin)) {
        std::istringstream line(bytes.substr(begin, end - begin));
        std::string        name;
        uint32_t           binding = 0;
        int                type    = 0;
        line >> name >> binding >> type;
        shader.bindings[name] = {binding, static_cast<BindingType>(type)};
    }
    shader.spirv.resize((bytes.size() - begin - 1) / sizeof(uint32_t));
    std::memcpy(shader.spirv.data(), bytes.data() + begin + 1, shader.spirv.size() * sizeof(uint32_t));
    return shader;
}

/// From the disk if it was compiled before by the same compiler.
Shader compile_or_read(const ShaderSource& source, std::span<const std::filesystem::path> files)
{
    const glslang::Version version = glslang::GetVersion();
    const std::string      name    = fmt::format("shader-{}-{}.{}.{}", content_hash(key_of(source, files, read_file)),
                                                 version.major, version.minor, version.patch);
    const auto             kept    = read_cached(name);
    ShaderIncluder         includer(source);
    Shader                 shader = kept ? from_bytes(*kept, source) : compile(source, includer);
    if (!kept) write_cached(name, to_bytes(shader));
    shader.constants = constants_used(shader.spirv);
    mark_uses(shader);
    return shader;
}

} // namespace

uint32_t group_size(const Shader& shader)
{
    constexpr uint32_t           execution_mode = 16, constant = 43, execution_mode_id = 331; // instructions
    constexpr uint32_t           local_size = 17, local_size_id = 38;                         // modes
    std::map<uint32_t, uint32_t> constants;
    std::vector<uint32_t>        ids;
    uint32_t                     size = 0;
    for_each_instruction(shader.spirv, [&](std::span<const uint32_t> words) {
        const uint32_t opcode = opcode_of(words);
        if (opcode == execution_mode && words[2] == local_size)
            size = words[3] * words[4] * words[5];
        else if (opcode == execution_mode_id && words[2] == local_size_id)
            ids = {words[3], words[4], words[5]};
        else if (opcode == constant)
            constants[words[2]] = words[3];
    });
    return ids.empty() ? size : constants[ids[0]] * constants[ids[1]] * constants[ids[2]];
}

ShaderFilesHeld::ShaderFilesHeld(const Gpu& gpu) : gpu_(gpu)
{
    KnownShaders&         known = gpu.impl->shaders;
    const std::lock_guard lock(known.mutex);
    if (++known.holders == 1) look_again(known);
}

ShaderFilesHeld::~ShaderFilesHeld()
{
    const std::lock_guard lock(gpu_.impl->shaders.mutex);
    --gpu_.impl->shaders.holders;
}

std::vector<ShaderFile> shader_files(const Gpu& gpu, ShaderSource source)
{
    add_device_defines(gpu, source);
    ShaderIncluder includer(source);
    compile(source, includer);
    return includer.files();
}

Shader compile_shader(const Gpu& gpu, ShaderSource source)
{
    add_device_defines(gpu, source);
    // A sweep and the checks ask for the same shader hundreds of times, with other constants.
    KnownShaders&         shaders = gpu.impl->shaders;
    const std::lock_guard lock(shaders.mutex);
    if (shaders.holders == 0) look_again(shaders);
    const auto        files = files_read(shaders, source);
    const std::string key   = key_of(source, files, [&](const auto& path) { return state_of(shaders, path); });
    const auto        known = shaders.compiled.find(key);
    return known != shaders.compiled.end()
               ? known->second
               : shaders.compiled.emplace(key, compile_or_read(source, files)).first->second;
}

} // namespace ssrlab
