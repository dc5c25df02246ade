// Compiles GLSL files to SPIR-V with glslang and lists the interface of the shader.
#pragma once

#include "gpu/gpu.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace ssrlab {

enum class ShaderStage { vertex, fragment, compute };
enum class BindingType { storage_buffer, uniform_buffer, storage_image, sampled_image, texel_buffer };

struct ShaderBinding {
    uint32_t    binding = 0;
    BindingType type    = BindingType::storage_buffer;
    bool        reads = false, writes = false; // anywhere in the code; of buffers and storage images
};

struct Shader {
    std::string                          name; // file, for messages
    ShaderStage                          stage = ShaderStage::compute;
    std::vector<uint32_t>                spirv;
    std::map<std::string, ShaderBinding> bindings;  // set 0, by block or variable name; only what the shader uses
    std::set<uint32_t>                   constants; // constant_id of each specialization constant that its code uses
};

/// Returns the invocations of a workgroup, as the code of a compute shader says.
uint32_t group_size(const Shader& shader);

struct ShaderSource {
    std::filesystem::path                        file; // relative to the shader folder
    ShaderStage                                  stage         = ShaderStage::compute;
    std::map<std::string, std::string>           defines       = {};
    std::map<std::string, std::filesystem::path> include_files = {}; // virtual include name -> file
    std::map<std::string, std::string>           include_texts = {}; // virtual include name -> text
    std::vector<std::filesystem::path> include_folders = {}; // a plug-in's own: searched before those of the project
    std::map<std::string, std::filesystem::path> offered =
        {}; // what a plug-in would have to write -> the file that it would get
};

/// Returns the folder of the project's shaders.
std::filesystem::path shader_folder();
/// Returns the folder of the project's techniques and structures; their files may be included, too.
std::filesystem::path technique_folder();

/// While one of these lives, each file is read at most once, even if it changes: a frame has dozens of shaders.
class ShaderFilesHeld {
public:
    explicit ShaderFilesHeld(const Gpu& gpu);
    ~ShaderFilesHeld();
    ShaderFilesHeld(const ShaderFilesHeld&)            = delete;
    ShaderFilesHeld& operator=(const ShaderFilesHeld&) = delete;

private:
    const Gpu& gpu_;
};

/// Compiles a shader for the storage and passes of this device (GpuInfo::plain_buffers, lanes). Includes come from the
/// source itself, its folders and the shader folder. Throws SpecError with one line "FILE:LINE: message" per error;
/// what a file of include_files lacks is reported for that file.
Shader compile_shader(const Gpu& gpu, ShaderSource source);

} // namespace ssrlab
