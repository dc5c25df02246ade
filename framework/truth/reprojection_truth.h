// Where a reflection was one frame earlier: for each pixel that reflects, the place at which the same mirror showed the same point.
//
// The mirror ray of scene_truth.h meets a point R of some object, or the sky in its direction. In the frame before, R was at R' and
// the mirror where its own motion says. What is looked for is the position on that frame's image whose view ray meets the mirror and
// is reflected toward R'. Both frames are taken without jitter.
//   Flat mirror (a triangle whose corners have its own normal): exact. The eye sees the mirror image of R' in the mirror's plane, so
//     the answer is the projection of that image.
//   Curved mirror: Newton's method on the image of the frame before, with rays on the real triangles and interpolated normals. It
//     starts from three places; where they lead to different answers, or none, there is no answer.
//   Mirrors with a normal map have no answer: what they reflect depends on how the map was filtered. Nor has what joints bend.
#pragma once

#include "core/gbuffer_image.h"
#include "core/truth_class.h"
#include "scene/sequence.h"
#include "truth/scene_bvh.h"

namespace ssrlab {

/// `now`, `before`: the scene in both frames, with its hierarchy; `gbuffer`: this frame. threads = 0: all cores.
ReprojectionTruth reprojection_truth(const SceneBvh& now, const SceneBvh& before, const GBufferImage& gbuffer,
                                     const FrameMotion& motion, unsigned threads = 0);

} // namespace ssrlab
