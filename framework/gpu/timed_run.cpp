#include "gpu/timed_run.h"

#include "gpu/compute.h"

namespace ssrlab {

double time_second_run_ms(Gpu& gpu, const std::function<void(const Commands&)>& record)
{
    const Timestamps timestamps = make_timestamps(gpu, 2);
    for (int run = 0; run < 2; ++run)
        submit(gpu, [&](const Commands& commands) {
            barrier(commands);
            write_timestamp(commands, timestamps, 0);
            record(commands);
            barrier(commands);
            write_timestamp(commands, timestamps, 1);
        });
    return read_intervals_ms(gpu, timestamps)[0];
}

} // namespace ssrlab
