#include "frame/passes/pass_helpers.h"
#include "shared.h"

#include <fmt/format.h>

namespace ssrlab {
namespace {

static_assert(sizeof(HistoryCounts) == HISTORY_COUNTS * sizeof(uint32_t));

constexpr auto four_floats = vk::Format::eR32G32B32A32Sfloat;

} // namespace

FrameHistoryPtr make_history(Gpu& gpu, glm::ivec2 size_px)
{
    auto       history       = std::make_shared<FrameHistory>();
    const auto image         = [&](vk::Format format) { return make_storage_image(gpu, format, size_px); };
    history->size_px         = size_px;
    history->depth           = image(vk::Format::eR32Sfloat);
    history->gradient        = image(vk::Format::eR32Uint);
    history->normal          = image(four_floats);
    history->reflection      = image(four_floats);
    history->facts           = image(four_floats);
    history->reprojected     = image(four_floats);
    history->kept_reflection = image(four_floats);
    history->kept_facts      = image(four_floats);
    history->counts          = make_buffer(gpu, sizeof(HistoryCounts));
    return history;
}

void drop_history(FrameHistory& history) { history.view.reset(); }

std::string history_mismatch(const FrameHistory& history, glm::ivec2 size_px, const std::optional<FrameMotion>& motion)
{
    if (!history.view) return "no frame before this one";
    if (!motion) return "a cut: nothing came before this frame";
    const View &previous = motion->previous_view, &held = *history.view;
    if (history.size_px != size_px)
        return fmt::format("a cut: the frame before had {}x{} pixels", history.size_px.x, history.size_px.y);
    if (history.frame + 1 != motion->frame)
        return fmt::format("a cut: frame {} follows frame {}", motion->frame, history.frame);
    if (held.world_to_view != previous.world_to_view || held.focal_px != previous.focal_px ||
        held.projection != previous.projection || held.near_m != previous.near_m)
        return "a cut: the frame before had another view";
    return "";
}

void keep_history(Gpu& gpu, const ReadyFrame& frame, int number)
{
    if (!frame.inputs.history) throw std::logic_error("keep_history: the frame was made without a history");
    FrameHistory&  history      = *frame.inputs.history;
    const GBuffer& gbuffer      = *frame.inputs.lab->gbuffer;
    const bool     kept         = runs(frame.inputs.plan, "history");
    const bool     picture      = frame.inputs.plan.values.at("picture_history_weight") > 0;
    const bool     kept_picture = runs(frame.inputs.plan, "picture_history");
    if (picture && !*history.picture.image)
        for (GpuImage* image : {&history.picture, &history.kept_picture})
            *image = make_storage_image(gpu, four_floats, history.size_px);
    Bindings all = surface_bindings(gbuffer);
    all.insert({{"View", gbuffer.view_uniforms},
                {"gradient_image", gbuffer.gradient},
                {"previous_depth_image", history.depth},
                {"previous_gradient_image", history.gradient},
                {"previous_normal_image", history.normal},
                {"reflection_image", frame.inputs.buffers->reflection},
                {"previous_reflection_image", history.reflection},
                {"previous_facts_image", history.facts},
                {"shaded_image", frame.inputs.buffers->shaded},
                {"previous_picture_image", history.picture}});
    ShaderSource source{.file = "gbuffer/keep_history.comp"};
    if (!kept) source.defines.emplace("KEEP_REFLECTION", "1");
    if (picture && !kept_picture) source.defines.emplace("KEEP_PICTURE", "1");
    const ComputePass keep = make_compute_pass(gpu, compile_shader(gpu, source), all);
    submit(gpu, [&](const Commands& commands) {
        barrier(commands);
        dispatch(commands, keep, groups_of_8(history.size_px));
        if (kept) {
            record_copy(commands, history.kept_reflection, history.reflection);
            record_copy(commands, history.kept_facts, history.facts);
        }
        if (kept_picture) record_copy(commands, history.kept_picture, history.picture);
        barrier(commands);
    });
    history.view  = gbuffer.view;
    history.frame = number;
}

std::vector<glm::vec2> read_reprojection(Gpu& gpu, const ReadyFrame& frame)
{
    std::vector<glm::vec2> vectors_px;
    if (!runs(frame.inputs.plan, "reprojection")) return vectors_px;
    for (const glm::vec4& texel : download_as<glm::vec4>(gpu, frame.inputs.history->reprojected))
        vectors_px.emplace_back(texel);
    return vectors_px;
}

std::optional<HistoryCounts> read_history_counts(Gpu& gpu, const ReadyFrame& frame)
{
    if (!runs(frame.inputs.plan, "history")) return std::nullopt;
    return download_as<HistoryCounts>(gpu, frame.inputs.history->counts, 1)[0];
}

} // namespace ssrlab
