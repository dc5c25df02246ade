#include "gpu/command_notes.h"

#include <atomic>

namespace ssrlab {
namespace {
thread_local std::vector<NotedCommand>* noted = nullptr;
} // namespace

uint64_t new_storage_id()
{
    static std::atomic<uint64_t> last = 0;
    return ++last;
}

std::vector<NotedCommand> note_commands(Gpu& gpu, const std::function<void(const vk::raii::CommandBuffer&)>& record)
{
    std::vector<NotedCommand> commands;
    vk::raii::CommandBuffers  unused(nullptr);
    if (!gpu.info.compiles_only) { // which draws nothing
        unused = {gpu.impl->device, {.commandPool = *gpu.impl->command_pool, .commandBufferCount = 1}};
        unused[0].begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    }
    const vk::raii::CommandBuffer none = nullptr;
    noted                              = &commands;
    try {
        record(unused.empty() ? none : unused[0]);
    } catch (...) {
        noted = nullptr;
        throw;
    }
    noted = nullptr;
    return commands;
}

bool are_noted() { return noted != nullptr; }

bool note(const NotedCommand& command)
{
    if (noted != nullptr) noted->push_back(command);
    return noted != nullptr;
}

} // namespace ssrlab
