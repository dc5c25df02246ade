// Sequences: where objects and the camera are in each frame. A frame has the same bits whatever was asked for before
// it.
#pragma once

#include "scene/scene.h"

#include <optional>

namespace ssrlab {

/// Which frame of a sequence.
struct SequenceFrame {
    int frame         = 0; // from 0: the scene as it was loaded, the first camera of a path
    int jitter_phases = 0; // sub-pixel offsets of the camera that repeat after so many frames; 0: none

    bool operator==(const SequenceFrame&) const = default;
};

inline constexpr int max_frames = 1'000'000, max_jitter_phases = 1024;

/// From the world of frame 0 to the world of this frame.
glm::dmat4 pose(const RigidMotion& motion, int frame);
/// From the world of this frame to the world of an earlier one; the identity for what stands still.
glm::dmat4 current_to_previous(const RigidMotion& motion, int frame, int frames_back = 1);

bool anything_moves(const Scene& scene);
/// Returns the scene with its vertices where they are in this frame. Motions stay those of frame 0.
Scene scene_at(const Scene& scene, int frame);

/// Returns the jitter in pixels, each coordinate in [-0.5, 0.5): Halton points to the bases 2 and 3, from index 1 on
/// (J. Halton 1964, Algorithm 247). 0 without jitter.
glm::dvec2 jitter_px(SequenceFrame at);
/// Returns the camera of a view or path without jitter. Throws SpecError listing the names.
Camera unjittered_camera_at(const Scene& scene, const std::string& view, int frame);
/// The same with its jitter in Camera::shift_px.
Camera camera_at(const Scene& scene, const std::string& view, SequenceFrame at);
/// Returns the view of that camera; size 0x0 means the camera's own. Throws SpecError if a frame file is asked for
/// another view, size or frame.
View view_at(const Scene& scene, const std::string& view, glm::ivec2 size_px, SequenceFrame at);

/// From one frame to a later one, usually the next.
struct FrameMotion {
    int                     frame = 0;           // to this one
    View                    view, previous_view; // without jitter
    std::vector<glm::dmat4> to_previous_ws; // by draw: world of this frame to world of the one before; NaN: not known
    bool                    camera_moves = false;
    int                     moving_draws = 0;
};

/// Returns nullopt where no frame comes before: frame 0, a cut, a frame file. `scene` may be in any frame.
std::optional<FrameMotion> motion_at(const Scene& scene, const std::string& view, glm::ivec2 size_px, int frame,
                                     int frames_back = 1);

} // namespace ssrlab
