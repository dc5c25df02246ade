// The device that all GPU tests share, opened with the validation layer.
#pragma once

#include "core/error.h"
#include "frame/stage.h"
#include "test.h"

namespace ssrlab::test {

Gpu& device();
/// Layers that a picture may have on this device: passes at the end of a frame need images for each.
int most_layers();
/// SwiftShader draws less exactly than by rounding (docs/explanation/devices.md): tests of last digits leave it out.
bool draws_exactly();

/// All of the tree, and what main.cpp names in $SSRLAB_TECHNIQUES.
const Catalogue& catalogue();
const Technique& technique(const std::string& id);

/// Its defaults with some values changed.
ParameterValues values_of(const Technique& technique, const ParameterValues& changed = {});

/// A scene, a view and its G-buffer on the device and on the host.
struct Picture {
    View            view;
    DrawingPtr      drawing; // null: made by hand
    GBufferPtr      gbuffer;
    GBufferImage    image;
    FrameBuffersPtr buffers;
};
Picture make_picture(const std::string& scene, const std::string& view, glm::ivec2 size_px);
Picture make_picture(const Scene& scene, const Camera& camera, glm::ivec2 size_px);
/// A G-buffer made by hand. Picture::image is what the device holds of it (unusable depth has become background).
Picture make_picture(const GBufferImage& gbuffer);

/// The passes as J. Somerville Roberts' report has them: metallic ^ 3, and fades toward the viewer and the edges.
inline ParameterValues report_passes()
{
    ParameterValues passes = default_pass_values();
    for (const auto& [name, value] :
         ParameterValues{chosen(Reflectance::metallic), chosen(ViewerFade::linear), chosen(EdgeFade::manhattan),
                         chosen(HitShading::diffuse), chosen(Gloss::blur)})
        passes.at(name) = value;
    return passes;
}

/// Every builtin scene, and these of models and textures.
std::vector<std::string> made_scenes_and(std::vector<std::string> names);

/// A frame as it is planned and made.
FramePtr prepared_frame(const FrameBuffersPtr& buffers, const Technique& technique, const ParameterValues& values,
                        const FrameSettings& settings, const FrameHistoryPtr& history = nullptr);
const FramePlan& plan_of(const ReadyFrame& frame);
/// Traces the mirror rays of the frame's G-buffer.
TraceImage counted(const ReadyFrame& frame, NumberFormat number_format = NumberFormat::float32);
/// The lab on a picture, with its layers.
LabPtr    lab_on_picture(const Picture& picture, const Technique& technique, const ParameterValues& values,
                         const TraceSettings& settings);
TracerPtr tracer_on(const GBufferPtr& gbuffer, const Technique& technique, const ParameterValues& values,
                    const TraceSettings& settings, size_t capacity, NumberFormat number_format = NumberFormat::float32);

TraceImage trace(const Picture& picture, const Technique& technique, const ParameterValues& values,
                 const TraceSettings& settings, NumberFormat number_format = NumberFormat::float32);

/// What the device lacks for arithmetic = exact; empty: nothing.
std::string missing_for_exact();

/// The command that repeats a trace outside the tests.
std::string repeat_command(const std::string& scene, const std::string& view, glm::ivec2 size_px,
                           const Technique& technique, const ParameterValues& values, const TraceSettings& settings);

/// How far apart two t may be to count as the same.
constexpr double bit_equal_t = 0, double_twins_t = 1e-9, any_t = std::numeric_limits<double>::infinity();
/// Rays whose status, hit pixel, layer or hit t differ; `first` describes the first of them.
size_t count_differences(const TraceImage& a, const TraceImage& b, double t_tolerance, std::string& first);

} // namespace ssrlab::test
