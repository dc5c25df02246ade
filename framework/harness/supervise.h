// A sweep works in a child process, so a crash or hang costs one run, not the sweep. Nothing else ends an endless
// shader on a software device. The child is a new process: a fork would lose threads that libraries start early.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

namespace ssrlab {

/// The run at which an earlier child ended, and why. Plain bytes in memory that two processes share.
struct LostRun {
    char run_id[24]    = {}; // empty: none was lost
    char why[160]      = {};
    bool whole_picture = false; // all runs on its frame were lost
};

/// Memory shared by parent and child.
struct SweepState {
    std::atomic<int64_t> deadline_ms{0};        // of the current step, on the steady clock; 0: none
    double               limit_s       = 0;     // from which the deadline follows
    char                 run_id[24]    = {};    // of the current run; empty: none
    bool                 whole_picture = false; // the current step concerns all runs on that run's frame
    LostRun              lost          = {};
    uint64_t written = 0, failed = 0, messages = 0; // rows, and messages of the validation layer, by all children
};

/// Marks a run as current while this object lives. `limit_s`: time limit, without the time in which its threads wait
/// for a processor that other programs use; 0: no limit.
class UnderWay {
public:
    UnderWay(SweepState& state, const std::string& run_id, double limit_s, bool whole_picture = false);
    ~UnderWay();
    UnderWay(const UnderWay&)            = delete;
    UnderWay& operator=(const UnderWay&) = delete;

private:
    SweepState& state_;
};

/// Returns the memory shared with the parent in a child of supervise(), else null.
SweepState* shared_with_parent();

/// Runs `command` in a child process, and in a new one whenever a child ends within a run (SweepState::lost). Returns
/// the last child's exit code, but not 0 if a run was lost; 128 + signal if a child was ended outside of runs.
int supervise(const std::vector<std::string>& command);

/// Returns the command line of this process.
std::vector<std::string> own_command();

} // namespace ssrlab
