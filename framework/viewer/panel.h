// What stands beside the picture: everything that can be changed, what was measured, and the ray under the cursor.
#pragma once

#include "viewer/session.h"

namespace ssrlab {

inline constexpr int panel_width_px = 400;

void draw_panel(Session& session, const std::optional<PixelRay>& ray, float height_px);

} // namespace ssrlab
