// Wall time since a moment.
#pragma once

#include <chrono>

namespace ssrlab {

/// Runs from when it is made.
class Stopwatch {
public:
    double seconds() const { return std::chrono::duration<double>(Clock::now() - started_).count(); }

private:
    using Clock                = std::chrono::steady_clock;
    Clock::time_point started_ = Clock::now();
};

} // namespace ssrlab
