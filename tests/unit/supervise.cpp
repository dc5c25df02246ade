// What becomes of a sweep whose process ends or hangs. The children are this program, with one of the tests that are disabled here.
#include "harness/supervise.h"
#include "harness/stop_signal.h"
#include "test.h"

#include <csignal>
#include <ctime>
#include <sched.h>
#include <sys/prctl.h>
#include <unistd.h>

namespace ssrlab {
namespace {

int run_child(const std::string& name)
{
    return supervise({"child", "--gtest_also_run_disabled_tests", "--gtest_filter=Child.DISABLED_" + name});
}

/// In the second child: 0 when it is told of this run, else 9.
[[noreturn]] void expect_lost(const SweepState& state, const char* why, bool whole_picture)
{
    const bool told = std::strcmp(state.lost.run_id, "r1") == 0 && std::strcmp(state.lost.why, why) == 0 &&
                      state.lost.whole_picture == whole_picture && state.written == 5;
    ::_exit(told ? 0 : 9);
}

SweepState& state_in_child()
{
    SweepState* state = shared_with_parent();
    if (state == nullptr) ::_exit(99);
    return *state;
}

bool is_first(SweepState& state) { return state.written == 0 && (state.written = 5); }

TEST(Child, DISABLED_Exits) { ::_exit(state_in_child().failed == 0 ? 42 : 1); }

TEST(Child, DISABLED_RunCrashes)
{
    SweepState& state = state_in_child();
    if (!is_first(state)) expect_lost(state, "ended its process: signal 9 (Killed)", false);
    const UnderWay under_way(state, "r1", 60);
    ::raise(SIGKILL);
}

TEST(Child, DISABLED_PictureCrashes)
{
    SweepState& state = state_in_child();
    if (!is_first(state)) expect_lost(state, "ended its process: signal 9 (Killed)", true);
    const UnderWay under_way(state, "r1", 0, true);
    ::raise(SIGKILL);
}

TEST(Child, DISABLED_RunHangs)
{
    SweepState& state = state_in_child();
    if (!is_first(state)) expect_lost(state, "did not end within 0.2 s (time_limit_s)", false);
    const UnderWay under_way(state, "r1", 0.2);
    std::this_thread::sleep_for(std::chrono::seconds(60));
}

TEST(Child, DISABLED_RunEndsInTime)
{
    {
        const UnderWay under_way(state_in_child(), "r1", 0.05);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    ::_exit(4);
}

void pin_to_first_processor()
{
    cpu_set_t mine, first;
    ::sched_getaffinity(0, sizeof(mine), &mine);
    CPU_ZERO(&first);
    for (size_t i = 0; i < CPU_SETSIZE; ++i)
        if (CPU_ISSET(i, &mine)) {
            CPU_SET(i, &first);
            break;
        }
    ::sched_setaffinity(0, sizeof(first), &first);
}

double processor_s()
{
    timespec spent{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &spent);
    return static_cast<double>(spent.tv_sec) + 1e-9 * static_cast<double>(spent.tv_nsec);
}

/// Five other processes want its processor: 0.3 s of work take some 2 s.
TEST(Child, DISABLED_RunWaitsForOthers)
{
    SweepState& state = state_in_child();
    pin_to_first_processor();
    std::array<pid_t, 5> others{};
    for (pid_t& other : others) {
        other = ::fork();
        if (other == 0) ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        while (other == 0) {}
    }
    {
        const UnderWay under_way(state, "r1", 0.8);
        const auto     begun   = std::chrono::steady_clock::now();
        const double   spent_s = processor_s();
        while (processor_s() < spent_s + 0.3) {}
        if (std::chrono::steady_clock::now() - begun < std::chrono::seconds(1)) ::_exit(3); // nobody was in its way
    }
    for (const pid_t other : others) ::kill(other, SIGKILL);
    ::_exit(4);
}

TEST(Child, DISABLED_CrashesOutsideOfARun)
{
    {
        const UnderWay under_way(state_in_child(), "r1", 60);
    }
    ::raise(SIGKILL);
}

TEST(Child, DISABLED_WaitsForASignal)
{
    listen_for_stop();
    ::kill(::getppid(), SIGTERM);
    for (int i = 0; i < 1000 && stop_requested() == 0; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ::_exit(stop_requested());
}

TEST(Supervise, GivesTheExitCodeOfItsChild) { EXPECT_EQ(run_child("Exits"), 42); }
TEST(Supervise, GoesOnAfterARunThatEndsTheProcess) { EXPECT_EQ(run_child("RunCrashes"), 1); }
TEST(Supervise, GoesOnAfterAPictureThatEndsTheProcess) { EXPECT_EQ(run_child("PictureCrashes"), 1); }
TEST(Supervise, EndsARunThatTakesTooLong) { EXPECT_EQ(run_child("RunHangs"), 1); }
TEST(Supervise, LeavesWhatIsNotUnderWayAlone) { EXPECT_EQ(run_child("RunEndsInTime"), 4); }
TEST(Supervise, ABusyMachineEndsNoRun) { EXPECT_EQ(run_child("RunWaitsForOthers"), 4); }
TEST(Supervise, ADeathOutsideOfEveryRunIsTheSweeps) { EXPECT_EQ(run_child("CrashesOutsideOfARun"), 128 + SIGKILL); }
TEST(Supervise, PassesOnWhatAsksToStop) { EXPECT_EQ(run_child("WaitsForASignal"), SIGTERM); }

} // namespace
} // namespace ssrlab
