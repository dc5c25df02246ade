// Pins the threads of llvmpipe, which splits each pass over one thread per core. When a pass wakes them, Linux may
// leave several on one core for milliseconds; on two cores such a pass takes twice as long.
#pragma once

#include <set>

namespace ssrlab {

/// Returns the ids of the threads of this process.
std::set<int> thread_ids();
/// Pins each thread started since then to a core of its own, in turn, among those that this process may use.
void spread_threads_since(const std::set<int>& before);

} // namespace ssrlab
