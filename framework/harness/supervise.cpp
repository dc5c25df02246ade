#include "harness/supervise.h"

#include "core/error.h"
#include "core/files.h"
#include "harness/stop_signal.h"

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <sstream>
#include <thread>

namespace ssrlab {
namespace {

int64_t now_ms()
{
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
}

constexpr const char* state_variable = "SSRLAB_SWEEP_STATE"; // number of the file that the state lies in

SweepState* map_state(int fd)
{
    void* bytes = ::mmap(nullptr, sizeof(SweepState), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    return bytes == MAP_FAILED ? nullptr : static_cast<SweepState*>(bytes);
}

template <size_t Size> void put(char (&field)[Size], const std::string& text) { field[text.copy(field, Size - 1)] = 0; }

/// The run that is under way becomes the one that was lost.
void lose(SweepState& state, const std::string& why)
{
    put(state.lost.run_id, state.run_id);
    put(state.lost.why, why);
    state.lost.whole_picture = state.whole_picture;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts)
{
    std::vector<char*> pointers;
    for (std::string& text : texts) pointers.push_back(text.data());
    pointers.push_back(nullptr);
    return pointers;
}

pid_t start(std::vector<std::string> command, int state_fd)
{
    std::vector<std::string> environment = {fmt::format("{}={}", state_variable, state_fd)};
    for (char** entry = environ; *entry != nullptr; ++entry) environment.emplace_back(*entry);
    const auto  arguments = pointers_to(command), variables = pointers_to(environment);
    const pid_t parent = ::getpid(), child = ::fork();
    if (child < 0) throw_failure("no process could be started: {}", std::strerror(errno));
    if (child > 0) return child;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() == parent) ::execve("/proc/self/exe", arguments.data(), variables.data());
    ::_exit(127);
}

struct End {
    int  status = 0;     // as waitpid() says
    bool lost   = false; // a run, which the state names
};

/// Passes on the first signal that asks to stop, and ends the child at its deadline.
End wait_for(pid_t child, SweepState& state)
{
    End  end;
    bool passed_on = false;
    for (;;) {
        const pid_t ended = ::waitpid(child, &end.status, WNOHANG);
        if (ended == child) break;
        if (ended < 0 && errno != EINTR) throw_failure("the sweep's process was lost: {}", std::strerror(errno));
        if (stop_requested() != 0 && !passed_on) {
            passed_on = true;
            ::kill(child, stop_requested());
        }
        const int64_t deadline_ms = state.deadline_ms;
        if (deadline_ms != 0 && now_ms() > deadline_ms && !end.lost) {
            end.lost = true;
            lose(state, fmt::format("did not end within {} s (time_limit_s)", state.limit_s));
            ::kill(child, SIGKILL);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    if (!end.lost && WIFSIGNALED(end.status) && state.run_id[0] != 0) {
        const int signal = WTERMSIG(end.status);
        end.lost         = true;
        lose(state, fmt::format("ended its process: signal {} ({})", signal, ::strsignal(signal)));
    }
    return end;
}

} // namespace

UnderWay::UnderWay(SweepState& state, const std::string& run_id, double limit_s, bool whole_picture) : state_(state)
{
    put(state.run_id, run_id);
    state.whole_picture = whole_picture;
    state.limit_s       = limit_s;
    state.deadline_ms   = limit_s > 0 ? now_ms() + static_cast<int64_t>(limit_s * 1000) : 0;
}

UnderWay::~UnderWay()
{
    state_.deadline_ms = 0;
    state_.run_id[0]   = 0;
}

SweepState* shared_with_parent()
{
    const char* fd = std::getenv(state_variable);
    return fd == nullptr ? nullptr : map_state(std::atoi(fd));
}

std::vector<std::string> own_command()
{
    std::istringstream       bytes(read_file("/proc/self/cmdline"));
    std::vector<std::string> command;
    for (std::string argument; std::getline(bytes, argument, '\0');) command.push_back(argument);
    return command;
}

int supervise(const std::vector<std::string>& command)
{
    const int fd = ::memfd_create("sweep", 0);
    if (fd < 0 || ::ftruncate(fd, sizeof(SweepState)) != 0)
        throw_failure("no memory to share with a child process: {}", std::strerror(errno));
    SweepState* bytes = map_state(fd);
    if (bytes == nullptr) throw_failure("no memory to share with a child process: {}", std::strerror(errno));
    SweepState& state = *new (bytes) SweepState;
    listen_for_stop();
    for (;;) {
        const End end = wait_for(start(command, fd), state);
        if (WIFEXITED(end.status) && !end.lost) {
            const int code = WEXITSTATUS(end.status);
            return code == 0 && state.lost.run_id[0] != 0 ? 1 : code;
        }
        if (stop_requested() != 0) return 128 + stop_requested();
        if (!end.lost) {
            const int signal = WTERMSIG(end.status);
            std::fprintf(stderr, "ssrlab: the sweep was ended by signal %d (%s); continue with --resume\n", signal,
                         ::strsignal(signal));
            return 128 + signal;
        }
        state.deadline_ms = 0;
        state.run_id[0]   = 0;
    }
}

} // namespace ssrlab
