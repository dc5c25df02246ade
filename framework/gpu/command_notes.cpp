#include "gpu/command_notes.h"

namespace ssrlab {

uint64_t new_storage_id(Gpu& gpu) { return ++gpu.impl->storages; }

std::vector<NotedCommand> note_commands(Gpu& gpu, const std::function<void(const Commands&)>& record)
{
    std::vector<NotedCommand> noted;
    Commands                  unused(vk::raii::CommandBuffer(nullptr));
    if (!gpu.info.compiles_only) { // which draws nothing
        unused = make_commands(gpu);
        unused.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    }
    unused.noted = &noted;
    record(unused);
    return noted;
}

bool note(const Commands& commands, const NotedCommand& command)
{
    if (commands.noted != nullptr) commands.noted->push_back(command);
    return commands.noted != nullptr;
}

} // namespace ssrlab
