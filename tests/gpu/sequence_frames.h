// Frames of a sequence with their history.
#pragma once

#include "frame/frame_inputs.h"
#include "gpu/device.h"
#include "scene/sequence.h"

namespace ssrlab::test {

/// One frame of a sequence on the device.
struct SequencePicture {
    DrawingPtr      drawing;
    GBufferPtr      gbuffer;
    FrameBuffersPtr buffers;
};

inline SequencePicture picture_at(const Scene& first, const std::string& view, SequenceFrame at, glm::ivec2 size_px)
{
    const Scene     scene = scene_at(first, at.frame);
    SequencePicture picture;
    picture.drawing = draw_gbuffer(device(), upload_scene(device(), scene), view_at(scene, view, size_px, at),
                                   motion_at(scene, view, size_px, at.frame));
    picture.gbuffer = gbuffer_of(*picture.drawing);
    picture.buffers = make_frame_buffers(device(), picture.drawing);
    return picture;
}

inline FrameSettings sequence_settings(const ParameterValues& changed)
{
    FrameSettings settings{.trace = boxes({.thickness_m = 0.1, .max_distance_m = 100})};
    for (const auto& [name, value] : changed)
        if (name == "reprojection")
            settings.reprojection = catalogue().reprojections.at(static_cast<size_t>(value)).id;
        else
            settings.passes.insert_or_assign(name, value); // or of a strategy's own
    return settings;
}

/// A reprojection strategy by its id.
inline ParameterValues::value_type strategy(const std::string& id)
{
    const auto& strategies = catalogue().reprojections;
    const auto  found      = std::ranges::find(strategies, id, &Reprojection::id);
    if (found == strategies.end()) throw std::logic_error("no strategy " + id);
    return {"reprojection", static_cast<double>(found - strategies.begin())};
}

/// A frame, run once.
inline FramePtr run_picture(const SequencePicture& picture, const ParameterValues& passes,
                            const FrameHistoryPtr& history, const char* id = "hiz")
{
    auto frame =
        prepared_frame(picture.buffers, technique(id), values_of(technique(id)), sequence_settings(passes), history);
    run_frame(device(), *frame);
    return frame;
}

} // namespace ssrlab::test
