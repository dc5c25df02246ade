// Loops over image rows on several threads. Each takes the next free row, since neighbours cost alike.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace ssrlab {

/// Calls do_row(y) once for every y in [0, row_count). threads = 0: all cores. Rethrows the first exception.
template <typename DoRow> void parallel_rows(int row_count, unsigned threads, const DoRow& do_row)
{
    std::atomic<int>   next_row{0};
    std::exception_ptr error;
    std::mutex         error_mutex;
    const auto         work = [&] {
        try {
            for (int y = next_row++; y < row_count; y = next_row++) do_row(y);
        } catch (...) {
            const std::lock_guard lock(error_mutex);
            if (!error) error = std::current_exception();
            next_row = row_count;
        }
    };
    if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
    threads = std::min(threads, unsigned(std::max(row_count, 1)));
    {
        std::vector<std::jthread> helpers;
        for (unsigned i = 1; i < threads; ++i) helpers.emplace_back(work);
        work();
    }
    if (error) std::rethrow_exception(error);
}

/// Threads for little work per pixel: on a small image, starting threads takes longer than the work.
inline unsigned threads_for(int width, int height) { return int64_t{width} * height < 4096 ? 1 : 0; }

/// Calls do_pixel(index) once for every pixel of an image, index = y * width + x, on all cores.
template <typename DoPixel> void parallel_pixels(int width, int height, const DoPixel& do_pixel)
{
    parallel_rows(height, threads_for(width, height), [&](int y) {
        const size_t first = static_cast<size_t>(y) * static_cast<size_t>(width);
        for (size_t i = first; i < first + static_cast<size_t>(width); ++i) do_pixel(i);
    });
}

} // namespace ssrlab
