#include "scene/skin.h"

#include <algorithm>
#include <cmath>

namespace ssrlab {
namespace {

glm::vec3 unit_or_zero(glm::dvec3 v)
{
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? glm::vec3(v / length) : glm::vec3(0);
}

} // namespace

glm::dmat4 blended(const Influences& influences, const std::vector<glm::dmat4>& joints)
{
    glm::dmat4 sum(0);
    for (size_t i = 0; i < influences.weights.size(); ++i)
        if (influences.weights[i] != 0 && influences.joints[i] < joints.size())
            sum += double(influences.weights[i]) * joints[influences.joints[i]];
    return sum[3][3] != 0 ? sum / sum[3][3] : glm::dmat4(1);
}

void move_vertex(const glm::dmat4& matrix, glm::dvec3& position_ws, Vertex& vertex)
{
    const glm::dmat3 linear(matrix);
    const double     side = glm::determinant(linear) < 0 ? -1 : 1;
    // The cofactors: the inverse transpose times the determinant, which a flattening matrix has, too.
    const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                               glm::cross(linear[0], linear[1]));
    position_ws      = glm::dvec3(matrix * glm::dvec4(position_ws, 1));
    vertex.normal_ws = unit_or_zero(side * (cofactors * glm::dvec3(vertex.normal_ws)));
    if (vertex.tangent_ws.w != 0)
        vertex.tangent_ws = {unit_or_zero(linear * glm::dvec3(vertex.tangent_ws)), float(side) * vertex.tangent_ws.w};
}

glm::dmat4 pose(const Influences& influences, const JointPoses& joints, int frame)
{
    const glm::dmat4 first = blended(influences, joints->front());
    const glm::dmat4 now   = blended(influences, (*joints)[std::min(size_t(frame), joints->size() - 1)]);
    return glm::determinant(glm::dmat3(first)) != 0 ? now * glm::inverse(first) : glm::dmat4(1);
}

} // namespace ssrlab
