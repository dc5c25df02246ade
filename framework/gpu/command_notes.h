// Commands that are noted instead of recorded: what each reads and writes, to count the bytes that a frame moves.
#pragma once

#include "gpu/vulkan.h"

#include <glm/glm.hpp>

namespace ssrlab {

/// A buffer, an image, or a part of one. Equal ids: the same memory.
struct Storage {
    uint64_t id         = 0;
    uint64_t bytes      = 0;
    uint64_t item_bytes = 0; // of a texel or list entry
};
/// Returns an id that nothing else on this device has.
uint64_t new_storage_id(Gpu& gpu);

struct StorageUse {
    Storage     of;
    bool        reads = false, writes = false;
    std::string name = {}; // in the shader
};

struct NotedCommand {
    std::vector<StorageUse> uses;
    const ComputePipeline*  pipeline = nullptr; // null: a copy, a fill, or the targets of a draw
    glm::uvec3              groups{0};          // of a dispatch; 0 where `launch` holds them
    const Buffer*           launch = nullptr;
};

/// Records on no device: returns the commands that `record` would record. Draws are noted by their targets alone.
std::vector<NotedCommand> note_commands(Gpu& gpu, const std::function<void(const Commands&)>& record);
/// Notes a command if these are noted; returns whether they are.
bool note(const Commands& commands, const NotedCommand& command);

} // namespace ssrlab
