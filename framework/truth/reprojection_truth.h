// Where a reflection was one frame earlier: for each reflecting pixel, the place where the same mirror showed the same
// point.
// The mirror ray of scene_truth.h meets a point R of an object, or the sky. In the frame before, R was at R'. The
// answer is the position on that frame's image whose view ray the same mirror reflected toward R'. Jitter is left out
// in both frames.
//   Flat mirror (a triangle whose corners have its own normal): exact. The eye sees the mirror image of R' in the
//     mirror plane, so the answer is the projection of that image.
//   Curved mirror: Newton's method on the previous image, with rays on the real triangles and interpolated normals; it
//     starts from three places; if they lead to different answers, or none, there is no answer.
//   Mirrors with a normal map and skinned surfaces have no answer.
#pragma once

#include "core/gbuffer_image.h"
#include "core/truth_class.h"
#include "scene/sequence.h"
#include "truth/scene_bvh.h"

namespace ssrlab {

/// Returns that truth. `now`, `before`: the scene in both frames; `gbuffer`: this frame. threads = 0: all cores.
ReprojectionTruth reprojection_truth(const SceneBvh& now, const SceneBvh& before, const GBufferImage& gbuffer,
                                     const FrameMotion& motion, unsigned threads = 0);

} // namespace ssrlab
