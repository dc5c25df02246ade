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

ParameterValues adjusted(const HardCase& hard_case, const Technique& technique, ParameterValues values)
{
    if (hard_case.adjust) hard_case.adjust(technique, values);
    return values;
}

} // namespace ssrlab
