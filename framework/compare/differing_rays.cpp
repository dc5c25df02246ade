#include "compare/differing_rays.h"

#include <cmath>

namespace ssrlab {

bool differs_at(const TraceImage& a, const TraceImage& b, size_t ray, double t_tolerance)
{
    if (a.status[ray] != b.status[ray]) return true;
    return has_place(a.status[ray]) && !(a.hit_pixel[ray] == b.hit_pixel[ray] && a.hit_layer[ray] == b.hit_layer[ray] &&
                                         std::abs(a.hit_t[ray] - b.hit_t[ray]) <= t_tolerance);
}

size_t count_differing_rays(const TraceImage& a, const TraceImage& b, double t_tolerance)
{
    size_t count = 0;
    for (size_t i = 0; i < a.status.size(); ++i) count += differs_at(a, b, i, t_tolerance);
    return count;
}

} // namespace ssrlab
