// Blocks of GLSL that stand for the same buffer. Folder-internal.
#pragma once

#include <functional>
#include <string>

namespace ssrlab {

/// The resource behind a block's name.
using ResourceOf = std::function<std::string(const std::string&)>;

/// Returns the GLSL of an exported pass with one block in the place of all those of a buffer that the pass writes:
/// WebGPU and D3D12 let no dispatch write a buffer that it also binds elsewhere.
std::string with_one_block_where_written(const std::string& glsl, const ResourceOf& resource_of);

} // namespace ssrlab
