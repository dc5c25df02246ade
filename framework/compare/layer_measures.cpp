// What the second depth layer adds to the first.
#include "compare/measures.h"

namespace ssrlab {

MeasureValues compare_hidden_layer(const TraceImage& first, const TraceImage& second, const SceneTruth& truth)
{
    require_same_size(first.size_px, truth.size_px);
    require_same_size(second.size_px, truth.size_px);
    size_t rays = 0, hidden = 0, recovered = 0, ghosts = 0, filled = 0, found = 0, wrong = 0;
    for (size_t i = 0; i < truth.cls.size(); ++i) {
        if (truth.cls[i] == TruthClass::not_traced) continue;
        const bool is_hidden = truth.cls[i] == TruthClass::hidden;
        const bool on_screen = is_hidden || truth.cls[i] == TruthClass::visible;
        const bool is_ghost  = on_screen && first.status[i] != TraceStatus::hit;
        const bool hits      = second.status[i] == TraceStatus::hit;
        const bool right     = hits && on_screen &&
                           screen_distance_px(glm::dvec2(second.hit_px_depth[i]), truth.point_px[i]) <= within_one_px;
        ++rays;
        hidden += is_hidden;
        recovered += is_hidden && right;
        ghosts += is_ghost;
        filled += is_ghost && hits;
        found += hits;
        wrong += hits && !right;
    }
    return {{"hidden_recovered_share", share(recovered, hidden)},
            {"ghost_share", share(ghosts, rays)},
            {"ghost_removed_share", share(filled, ghosts)},
            {"hidden_layer_hits", share(found, rays)},
            {"hidden_layer_wrong", share(wrong, found)}};
}

} // namespace ssrlab
