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
#include <filesystem>
#include <fstream>
#include <map>
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

/// Nanoseconds that each thread of a process has waited for a processor while others had it. Empty where the kernel does not tell.
std::map<std::string, int64_t> waits_ns(pid_t process)
{
    std::map<std::string, int64_t> waits;
    std::error_code                gone;
    const std::filesystem::path    threads = fmt::format("/proc/{}/task", process);
    for (const auto& thread : std::filesystem::directory_iterator(threads, gone)) {
        std::ifstream file(thread.path() / "schedstat");
        int64_t       ran_ns = 0, waited_ns = 0;
        if (file >> ran_ns >> waited_ns) waits.emplace(thread.path().filename(), waited_ns);
    }
    return waits;
}

/// Postpones a run's deadline by the time that its process had to wait for others, so that a busy machine ends no run.
class Patience {
public:
    explicit Patience(pid_t child) : child_(child), waits_ns_(waits_ns(child)) {}

    void postpone(std::atomic<int64_t>& deadline_ms)
    {
        int64_t longest_ns = 0;
        auto    now        = waits_ns(child_);
        for (const auto& [thread, waited_ns] : now) {
            const auto before = waits_ns_.find(thread);
            longest_ns        = std::max(longest_ns, waited_ns - (before == waits_ns_.end() ? 0 : before->second));
        }
        waits_ns_    = std::move(now);
        int64_t then = deadline_ms;
        // Where the deadline has changed meanwhile, another run is under way, or none.
        if (then != 0) deadline_ms.compare_exchange_strong(then, then + longest_ns / 1'000'000);
        checked_ms_ = now_ms();
    }
    bool is_due() const { return now_ms() > checked_ms_ + 1000; }

private:
    pid_t                          child_;
    std::map<std::string, int64_t> waits_ns_;
    int64_t                        checked_ms_ = now_ms();
};

bool is_past(int64_t deadline_ms) { return deadline_ms != 0 && now_ms() > deadline_ms; }

/// Passes on the first signal that asks to stop, and ends the child at its deadline.
End wait_for(pid_t child, SweepState& state)
{
    End      end;
    Patience patience(child);
    bool     passed_on = false;
    for (;;) {
        const pid_t ended = ::waitpid(child, &end.status, WNOHANG);
        if (ended == child) break;
        if (ended < 0 && errno != EINTR) throw_failure("the sweep's process was lost: {}", std::strerror(errno));
        if (stop_requested() != 0 && !passed_on) {
            passed_on = true;
            ::kill(child, stop_requested());
        }
        if (patience.is_due() || is_past(state.deadline_ms)) patience.postpone(state.deadline_ms);
        if (is_past(state.deadline_ms) && !end.lost) {
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
