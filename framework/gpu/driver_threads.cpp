#include "gpu/driver_threads.h"

#include <sched.h>

#include <filesystem>
#include <string>
#include <vector>

namespace ssrlab {

std::set<int> thread_ids()
{
    std::set<int>   ids;
    std::error_code none; // without /proc no thread is known, and none is moved
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task", none))
        ids.insert(std::stoi(entry.path().filename().string()));
    return ids;
}

void spread_threads_since(const std::set<int>& before)
{
    cpu_set_t allowed;
    if (sched_getaffinity(0, sizeof(allowed), &allowed) != 0) return;
    std::vector<size_t> cores;
    for (size_t core = 0; core < CPU_SETSIZE; ++core)
        if (CPU_ISSET(core, &allowed)) cores.push_back(core);
    size_t turn = 0;
    for (const int id : thread_ids()) {
        if (before.contains(id)) continue;
        cpu_set_t one;
        CPU_ZERO(&one);
        CPU_SET(cores[turn++ % cores.size()], &one);
        sched_setaffinity(id, sizeof(one), &one); // of a thread that has ended since: nothing
    }
}

} // namespace ssrlab
