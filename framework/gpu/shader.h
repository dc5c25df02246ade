// GLSL files to SPIR-V by glslang, with what the shader says about its own interface.
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
};

struct Shader {
    std::string                          name; // file, for messages
    ShaderStage                          stage = ShaderStage::compute;
    std::vector<uint32_t>                spirv;
    std::map<std::string, ShaderBinding> bindings;  // set 0, by block or variable name; only what the shader uses
    std::set<uint32_t>                   constants; // constant_id of each specialization constant that its code uses
};

/// Invocations of a workgroup, as its code says; of a compute shader.
uint32_t group_size(const Shader& shader);

struct ShaderSource {
    std::filesystem::path                        file; // relative to the shader folder
    ShaderStage                                  stage         = ShaderStage::compute;
    std::map<std::string, std::string>           defines       = {};
    std::map<std::string, std::filesystem::path> include_files = {}; // virtual include name -> file
    std::map<std::string, std::string>           include_texts = {}; // virtual include name -> text
    std::vector<std::filesystem::path> include_folders = {}; // a plug-in's own: searched before those of the project
};

/// Where the project's shaders lie.
std::filesystem::path shader_folder();
/// Where the project's techniques and structures lie: their files may be included, too.
std::filesystem::path technique_folder();

/// While one lives, each file is looked at once, changed or not: a frame has dozens of shaders, the project hundreds of files.
class ShaderFilesHeld {
public:
    ShaderFilesHeld();
    ~ShaderFilesHeld();
    ShaderFilesHeld(const ShaderFilesHeld&)            = delete;
    ShaderFilesHeld& operator=(const ShaderFilesHeld&) = delete;
};

/// Includes come from the source itself, its folders and the shader folder, and from nowhere else. Throws SpecError with a line
/// "FILE:LINE: message" for each error found; what is missing from a file of include_files is said of that file.
/// Shaders are made for a device's way of storing texels and of sharing work (GpuInfo::plain_buffers, lanes).
Shader compile_shader(const Gpu& gpu, ShaderSource source);

} // namespace ssrlab
