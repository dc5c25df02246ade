#include "check/hard_case.h"

namespace ssrlab {

const std::vector<CaseFamily>& hard_cases()
{
    static const std::vector<CaseFamily> families = {
        direction_cases(), border_cases(),    depth_cases(),    format_cases(),  size_cases(),
        camera_cases(),    scale_cases(),     rounding_cases(), surface_cases(), plane_cases(),
        normal_cases(),    parameter_cases(), motion_cases()};
    return families;
}

} // namespace ssrlab
