// llvmpipe's threads do not share a core while another is idle.
#include "gpu/driver_threads.h"
#include "core/files.h"
#include "gpu/device.h"

#include <sched.h>

#include <condition_variable>

namespace ssrlab::test {
namespace {

cpu_set_t cores_of(int thread)
{
    cpu_set_t cores;
    CPU_ZERO(&cores);
    EXPECT_EQ(sched_getaffinity(thread, sizeof(cores), &cores), 0);
    return cores;
}

/// Threads of llvmpipe that draw, by their numbers in its own count. Those that compute have no name.
std::map<std::string, int> drawing_threads()
{
    std::map<std::string, int> found;
    for (const int id : thread_ids()) {
        const std::string name = read_file("/proc/self/task/" + std::to_string(id) + "/comm");
        if (name.starts_with("llvmpipe-")) found.emplace(name, id);
    }
    return found;
}

TEST(DriverThreads, OfLlvmpipeHaveACoreEach)
{
    if (device().info.name.find("llvmpipe") == std::string::npos) GTEST_SKIP() << "another driver";
    const auto threads = drawing_threads();
    ASSERT_FALSE(threads.empty());
    const cpu_set_t own = cores_of(0);
    std::set<int>   taken;
    for (const auto& [name, id] : threads) {
        const cpu_set_t cores = cores_of(id);
        EXPECT_EQ(CPU_COUNT(&cores), 1) << name;
        for (int core = 0; core < CPU_SETSIZE; ++core)
            if (CPU_ISSET(core, &cores)) taken.insert(core);
    }
    EXPECT_EQ(taken.size(), std::min<size_t>(threads.size(), static_cast<size_t>(CPU_COUNT(&own))));
}

TEST(DriverThreads, NoOthersAreMoved)
{
    std::mutex              mutex;
    std::condition_variable changed;
    int                     started = 0;
    bool                    done    = false;
    const auto              wait    = [&] {
        std::unique_lock lock(mutex);
        ++started;
        changed.notify_all();
        changed.wait(lock, [&] { return done; });
    };
    const std::set<int> before = thread_ids();
    std::jthread        first(wait), second(wait);
    {
        std::unique_lock lock(mutex);
        changed.wait(lock, [&] { return started == 2; });
    }
    const cpu_set_t own = cores_of(0);
    spread_threads_since(before);
    size_t moved = 0;
    for (const int id : thread_ids()) {
        const cpu_set_t cores = cores_of(id);
        if (!before.contains(id) && CPU_COUNT(&cores) == 1) ++moved;
    }
    EXPECT_GE(moved, 2U);
    const cpu_set_t after = cores_of(0);
    EXPECT_TRUE(CPU_EQUAL(&own, &after)); // the thread that asked
    {
        const std::scoped_lock lock(mutex);
        done = true;
    }
    changed.notify_all();
}

} // namespace
} // namespace ssrlab::test
