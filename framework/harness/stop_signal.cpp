#include "harness/stop_signal.h"

#include <atomic>
#include <csignal>
#include <cstdint>
#include <ctime>

namespace ssrlab {
namespace {

// A terminal sends a signal to a sweep's two processes, and one passes it on to the other: it still asks once.
constexpr int64_t same_request_ms = 300;

std::atomic<int>     noted_signal = 0;
std::atomic<int64_t> noted_ms     = 0;
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<int64_t>::is_always_lock_free);

void note(int signal)
{
    timespec now = {};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    const int64_t now_ms = now.tv_sec * 1000 + now.tv_nsec / 1'000'000;
    if (noted_signal == 0) {
        noted_ms     = now_ms;
        noted_signal = signal;
    } else if (now_ms - noted_ms > same_request_ms && signal != SIGPIPE) {
        std::signal(signal, SIG_DFL);
        std::raise(signal); // once this handler has returned
    }
}

} // namespace

void listen_for_stop()
{
    noted_signal            = 0;
    struct sigaction action = {};
    action.sa_handler       = note;
    action.sa_flags         = SA_RESTART;
    for (const int signal : {SIGINT, SIGTERM, SIGQUIT, SIGPIPE}) ::sigaction(signal, &action, nullptr);
    struct sigaction before = {};
    ::sigaction(SIGHUP, nullptr, &before);
    if (before.sa_handler != SIG_IGN) ::sigaction(SIGHUP, &action, nullptr); // nohup asks to go on
    std::signal(SIGXFSZ, SIG_IGN);
}

int stop_requested() { return noted_signal; }

} // namespace ssrlab
