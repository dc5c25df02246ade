#include "harness/stop_signal.h"

#include <csignal>

namespace ssrlab {
namespace {

volatile std::sig_atomic_t noted_signal = 0;

} // namespace

void listen_for_stop()
{
    noted_signal            = 0;
    struct sigaction action = {};
    action.sa_handler       = [](int signal) { noted_signal = signal; };
    action.sa_flags         = static_cast<int>(SA_RESETHAND) | SA_RESTART;
    ::sigaction(SIGINT, &action, nullptr);
    ::sigaction(SIGTERM, &action, nullptr);
    std::signal(SIGXFSZ, SIG_IGN);
}

int stop_requested() { return noted_signal; }

} // namespace ssrlab
