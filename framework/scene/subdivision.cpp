// Longest-edge bisection (M.-C. Rivara 1984, "Algorithms for refining triangular grids suitable for adaptive and
// multigrid techniques").
#include "scene/subdivision.h"

#include "core/error.h"

#include <algorithm>
#include <unordered_map>

namespace ssrlab {
namespace {

constexpr size_t max_triangles = 4'000'000;

glm::vec3 unit_sum(glm::vec3 a, glm::vec3 b)
{
    const float length = glm::length(a + b);
    return length > 0 ? (a + b) / length : a;
}

/// The same for both orders of the ends where positions count.
Vertex between(const Vertex& a, const Vertex& b)
{
    Vertex middle     = a;
    middle.normal_ws  = unit_sum(a.normal_ws, b.normal_ws);
    middle.tangent_ws = {unit_sum(glm::vec3(a.tangent_ws), glm::vec3(b.tangent_ws)), a.tangent_ws.w};
    middle.uv0        = 0.5F * (a.uv0 + b.uv0);
    middle.uv1        = 0.5F * (a.uv1 + b.uv1);
    middle.colour     = 0.5F * (a.colour + b.colour);
    return middle;
}

class Subdivision {
public:
    explicit Subdivision(Mesh& mesh) : mesh_(mesh) {}

    /// Returns false if it would take more than `room` triangles.
    bool run(double edge_m, size_t room)
    {
        std::vector<uint32_t> open = std::move(mesh_.indices), done;
        while (!open.empty()) {
            const uint32_t c = take(open), b = take(open), a = take(open);
            const double   ab = length_m(a, b), bc = length_m(b, c), ca = length_m(c, a);
            const double   longest = std::max({ab, bc, ca});
            if (!(longest > edge_m))
                done.insert(done.end(), {a, b, c});
            else if (ab == longest)
                halve(open, a, b, c);
            else if (bc == longest)
                halve(open, b, c, a);
            else
                halve(open, c, a, b);
            if ((open.size() + done.size()) / 3 > room) return false;
        }
        mesh_.indices = std::move(done);
        return true;
    }

private:
    static uint32_t take(std::vector<uint32_t>& indices)
    {
        const uint32_t last = indices.back();
        indices.pop_back();
        return last;
    }

    double length_m(uint32_t a, uint32_t b) const { return glm::length(mesh_.positions_ws[a] - mesh_.positions_ws[b]); }

    void halve(std::vector<uint32_t>& open, uint32_t a, uint32_t b, uint32_t opposite)
    {
        const uint32_t middle = middle_of(a, b);
        open.insert(open.end(), {a, middle, opposite, middle, b, opposite});
    }

    uint32_t middle_of(uint32_t a, uint32_t b)
    {
        const uint64_t edge       = uint64_t(std::min(a, b)) << 32U | std::max(a, b);
        const auto [found, added] = middles_.try_emplace(edge, static_cast<uint32_t>(mesh_.vertices.size()));
        if (added) {
            mesh_.positions_ws.push_back(0.5 * (mesh_.positions_ws[a] + mesh_.positions_ws[b]));
            mesh_.vertices.push_back(between(mesh_.vertices[a], mesh_.vertices[b]));
        }
        return found->second;
    }

    Mesh&                                  mesh_;
    std::unordered_map<uint64_t, uint32_t> middles_; // by edge
};

} // namespace

void subdivide(Model& model, const Bake& bake)
{
    size_t room = max_triangles;
    for (Mesh& mesh : model.meshes) {
        if (mesh.skin.vertices.empty() && !Subdivision(mesh).run(bake.edge_m, room))
            throw_spec_error("{}: [bake]: edge_m = {} makes more than {} triangles; expected a greater length",
                             bake.place, bake.edge_m, max_triangles);
        room -= std::min(room, mesh.indices.size() / 3);
    }
}

} // namespace ssrlab
