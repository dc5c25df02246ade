#include "check/depth_format.h"

#include <algorithm>
#include <cmath>

namespace ssrlab {

const std::vector<DepthFormat>& depth_formats()
{
    static const std::vector<DepthFormat> formats = {{"D32 float, reversed, infinite", 32, true, true},
                                                     {"D32 float, reversed", 32, true, false},
                                                     {"D32 float, standard", 32, false, false},
                                                     {"D24, reversed", 24, true, false},
                                                     {"D24, standard", 24, false, false},
                                                     {"D16, reversed", 16, true, false},
                                                     {"D16, standard", 16, false, false}};
    return formats;
}

float stored_and_imported(const DepthFormat& format, float depth, double near_m, double far_m)
{
    if (!(depth > 0 && depth <= 1)) return depth;
    // depth = n/Z. Finite reversed: (n/Z - n/f) / (1 - n/f); standard: 1 - that.
    const double n_f    = format.infinite ? 0 : near_m / far_m;
    const double scaled = (static_cast<double>(depth) - n_f) / (1 - n_f);
    const double value  = format.reversed ? scaled : 1 - scaled;
    const double codes  = std::ldexp(1.0, format.bits) - 1;
    const double stored =
        format.bits == 32 ? static_cast<double>(static_cast<float>(value)) : std::round(value * codes) / codes;
    const double back = format.reversed ? stored : 1 - stored;
    return static_cast<float>(back * (1 - n_f) + n_f);
}

Setup stored_and_imported(Setup setup, const DepthFormat& format)
{
    float farthest = 1;
    for (const float depth : setup.gbuffer.depth)
        if (depth > 0 && depth <= 1) farthest = std::min(farthest, depth);
    const double near_m = setup.gbuffer.view.near_m, far_m = 1.5 * near_m / static_cast<double>(farthest);
    for (float& depth : setup.gbuffer.depth) depth = stored_and_imported(format, depth, near_m, far_m);
    return setup;
}

} // namespace ssrlab
