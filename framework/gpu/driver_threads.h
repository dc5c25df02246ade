// llvmpipe shares each pass among threads, one a core. Where a pass wakes them, Linux may leave them on one core together for some milliseconds, most
// often after something was drawn: on two cores such a pass takes twice as long, and its times have two peaks. So each thread gets a core of its own.
#pragma once

#include <set>

namespace ssrlab {

/// Threads of this process, by their numbers.
std::set<int> thread_ids();
/// Gives the threads that were started since then a core each, in turn, of those that this process may use.
void spread_threads_since(const std::set<int>& before);

} // namespace ssrlab
