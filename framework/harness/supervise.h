// A sweep works in a child process: what ends or hangs that process costs one run, not the sweep. On a software device nothing else can end
// a shader that does not end by itself. The child is a program started anew: libraries start threads early, which a fork would not have.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

namespace ssrlab {

/// The run at which an earlier child ended, and why. Plain bytes: they lie in memory that two processes share.
struct LostRun {
    char run_id[24]    = {}; // empty: none was lost
    char why[160]      = {};
    bool whole_picture = false; // it was lost with all runs on its picture
};

/// What the parent sees of its child, and tells it: memory that both have.
struct SweepState {
    std::atomic<int64_t> deadline_ms{0};        // of what is under way, on the steady clock; 0: none
    double               limit_s       = 0;     // that the deadline follows from
    char                 run_id[24]    = {};    // of the run that is under way; empty: none
    bool                 whole_picture = false; // what is under way concerns all runs on that run's picture
    LostRun              lost          = {};
    uint64_t written = 0, failed = 0, messages = 0; // rows, and messages of the validation layer, by all children
};

/// A run is under way as long as this lives. limit_s: how long that may be, not counting the time in which its threads
/// wait for a processor that other programs use; 0: without a limit.
class UnderWay {
public:
    UnderWay(SweepState& state, const std::string& run_id, double limit_s, bool whole_picture = false);
    ~UnderWay();
    UnderWay(const UnderWay&)            = delete;
    UnderWay& operator=(const UnderWay&) = delete;

private:
    SweepState& state_;
};

/// In a child of supervise(): what it shares with its parent. In any other process: null.
SweepState* shared_with_parent();

/// Runs `command` in a child process and, whenever one ends within a run, again in another, in which SweepState::lost says which run that was.
/// Returns the exit code: that of the last child, but not 0 when a run was lost; 128 + its signal when a child was ended outside of every run.
int supervise(const std::vector<std::string>& command);

/// The command of this very process.
std::vector<std::string> own_command();

} // namespace ssrlab
