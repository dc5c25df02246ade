#include "benchmarks/visits_bound.h"

#include "core/parallel_rows.h"
#include "core/pixel_index.h"
#include "truth/screen_ray.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace ssrlab {
namespace {

/// Border crossings along one axis.
struct Axis {
    double origin, inverse;
    bool   forward, flat;

    Axis(double from, double delta)
        : origin(from), inverse(1 / delta), forward(delta > 0), flat(!std::isfinite(inverse))
    {
    }
    double t_at(int border) const
    {
        return flat ? std::numeric_limits<double>::infinity() : (border - origin) * inverse;
    }
    double t_exit(int cell, int level) const { return t_at((cell + (forward ? 1 : 0)) << level); }
    int    next(int cell, double t_border, double t) const { return t_border <= t ? cell + (forward ? 1 : -1) : cell; }
    int    child(int cell, int level, double t) const
    {
        const bool beyond = t_at((2 * cell + 1) << (level - 1)) <= t;
        return 2 * cell + (beyond == (forward || flat) ? 1 : 0);
    }
};

uint64_t count_visits(const ScreenRay& ray, const TraceImage& truth, size_t index, int top_level)
{
    const glm::ivec2 size = truth.size_px, hit = truth.hit_pixel[index];
    const bool       hits = truth.status[index] == TraceStatus::hit;
    const Axis       x(ray.origin_px_depth.x, ray.delta_px_depth.x), y(ray.origin_px_depth.y, ray.delta_px_depth.y);
    const double     t_end = std::min({1.0, x.t_at(x.forward ? size.x : 0), y.t_at(y.forward ? size.y : 0)});
    double           t_x = x.t_exit(ray.start_pixel.x, 0), t_y = y.t_exit(ray.start_pixel.y, 0);
    double           t      = std::min(t_x, t_y);
    int              level  = 0;
    glm::ivec2       cell   = {x.next(ray.start_pixel.x, t_x, t), y.next(ray.start_pixel.y, t_y, t)};
    uint64_t         visits = 0;
    while (t < t_end) {
        ++visits;
        const bool touched = hits && (hit >> level) == cell;
        if (touched && level == 0) return visits;
        if (touched) {
            cell = {x.child(cell.x, level, t), y.child(cell.y, level, t)};
            --level;
            continue;
        }
        t_x                   = x.t_exit(cell.x, level);
        t_y                   = y.t_exit(cell.y, level);
        t                     = std::min(t_x, t_y);
        const glm::ivec2 next = {x.next(cell.x, t_x, t), y.next(cell.y, t_y, t)};
        const bool       up   = level < top_level && (next >> 1) != (cell >> 1);
        cell                  = up ? next >> 1 : next;
        level += up ? 1 : 0;
    }
    return visits;
}

} // namespace

double visits_with_perfect_cells(const GBufferImage& gbuffer, const TraceSettings& settings, const TraceImage& truth,
                                 int top_level)
{
    const glm::ivec2      size = gbuffer.view.size_px;
    std::vector<uint64_t> visits(static_cast<size_t>(size.y)), rays(static_cast<size_t>(size.y));
    parallel_rows(size.y, 0, [&](int row) {
        for (int column = 0; column < size.x; ++column) {
            const ScreenRay ray = make_screen_ray(gbuffer, {column, row}, settings);
            if (!ray.traced) continue;
            const size_t index = pixel_index({column, row}, size);
            visits[static_cast<size_t>(row)] += count_visits(ray, truth, index, top_level);
            ++rays[static_cast<size_t>(row)];
        }
    });
    const auto sum = [](const std::vector<uint64_t>& v) {
        return static_cast<double>(std::accumulate(v.begin(), v.end(), uint64_t{0}));
    };
    return sum(visits) / std::max(sum(rays), 1.0);
}

} // namespace ssrlab
