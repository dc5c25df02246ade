#include "viewer/session.h"

#include "compare/pictures.h"
#include "core/error.h"
#include "core/names.h"
#include "harness/choose_sources.h"
#include "harness/choose_technique.h"
#include "harness/experiment.h"
#include "harness/quality.h"
#include "sources/answered_frame.h"
#include "truth/glossy_truth.h"
#include "truth/scene_truth.h"
#include "truth/screen_truth.h"
#include "viewer/camera_motion.h"

#include <algorithm>
#include <cmath>

namespace ssrlab {
namespace {

constexpr size_t timed_frames        = 9;
constexpr double timing_budget_ms    = 1000;
constexpr int    true_rays_per_pixel = 16;

double spent_ms(const std::vector<FrameTimes>& times)
{
    double sum = 0;
    for (const FrameTimes& one : times) sum += one.total_ms();
    return sum;
}

bool wants_true_picture(const Session& session) { return session.show == "truth" || session.split > 0; }

void draw_view(Session& session)
{
    Stage& stage = session.stage;
    if (session.camera_moved) show(stage, camera_to_view(session.camera, stage.view.size_px));
    session.stale.view = false;
}

/// Replaces `auto` by the list that it chooses for this view. The list stays when the camera moves: choosing takes
/// seconds.
void choose_listed(Session& session)
{
    if (session.listed.empty() || session.listed.front().source->id != "auto") return;
    const Choice& choice  = session.choice;
    SourceContext context = make_source_context(session.stage, *session.technique, choice.values, choice.settings);
    session.listed        = choose_sources(context, session.listed, HandOn::uncertain).list;
}

void trace(Session& session)
{
    Stage& stage = session.stage;
    session.times.clear();
    choose_listed(session);
    const Choice&         choice  = session.choice;
    const bool            alone   = session.listed.empty();
    const LabPtr          lab     = make_lab(stage, *session.technique, choice.values, choice.settings.trace);
    const FrameBuffersPtr buffers = make_frame_buffers(stage);
    session.frame = make_frame(stage.gpu, lab, buffers, plan_frame(stage, lab, buffers, choice.settings), {},
                               alone ? Answers::own : Answers::given);
    if (alone) {
        run_frame(stage.gpu, *session.frame); // the driver compiles
        session.times.push_back(run_frame(stage.gpu, *session.frame));
    } else {
        SourceContext context = make_source_context(stage, lab);
        session.times.push_back(run_answered_frame(context, *session.frame, session.listed, HandOn::uncertain));
    }
    session.shaded         = read_shaded(stage.gpu, *session.frame);
    session.counted        = trace_gbuffer(stage.gpu, *make_tracer(stage.gpu, lab));
    session.stale.trace    = false;
    session.stale.measures = session.stale.answers = session.stale.shown = true;
}

bool wants_answers(const Session& session)
{
    return session.bvh && (session.show == "sources" || !session.listed.empty());
}

void find_answers(Session& session)
{
    const Choice& choice  = session.choice;
    const auto    list    = session.listed.empty() ? parse_sources("frame,world", "sources") : session.listed;
    SourceContext context = make_source_context(session.stage, *session.technique, choice.values, choice.settings);
    session.answered      = answer_rays(context, list, HandOn::uncertain);
    session.stale.answers = false;
    session.stale.shown   = true;
}

void find_truth(Session& session)
{
    const TraceSettings& settings = session.choice.settings.trace;
    session.gbuffer = read_gbuffer(session.stage.gpu, *session.stage.gbuffer); // with the layers that were traced
    if (session.bvh)
        session.scene_truth = scene_truth(*session.bvh, session.stage.scene, session.gbuffer, settings);
    else
        session.screen_truth = screen_truth(session.gbuffer, settings);
    session.stale.truth    = false;
    session.stale.measures = session.stale.shown = true;
}

void find_true_picture(Session& session)
{
    if (!session.bvh)
        throw_spec_error("a frame of another renderer has no triangles, so no true reflection can be computed");
    const FrameSettings& settings = session.choice.settings;
    const GlossyTruth    truth =
        glossy_truth(*session.bvh, session.stage.scene, session.gbuffer, settings.trace,
                     {.rays = true_rays_per_pixel, .metallic_exponent = metallic_exponent_of(settings.passes)});
    session.true_picture       = true_picture(truth, session.gbuffer, session.stage.scene.ambient);
    session.stale.true_picture = false;
    session.stale.shown        = true;
}

Image false_colours(const Session& session)
{
    if (session.show == "fetches") return fetch_heat_map(session.counted);
    if (session.show == "agreement")
        return session.scene_truth ? agreement_picture(session.counted, *session.scene_truth)
                                   : agreement_picture(session.counted, *session.screen_truth);
    if (!session.scene_truth)
        throw_spec_error("{}: a frame of another renderer has no triangles, so the cause of an error is not known",
                         session.show);
    if (session.show == "sources")
        return sources_picture(session.answered.answers, *session.scene_truth, session.gbuffer);
    return causes_picture(session.counted, *session.scene_truth, session.gbuffer);
}

/// The right part of one picture in the place of another's.
void replace_right(Image& left, const Image& right, double share)
{
    const int    width = left.size_px.x;
    const size_t from  = static_cast<size_t>(std::lround((1 - share) * width));
    for (size_t y = 0; y < static_cast<size_t>(left.size_px.y); ++y) {
        const auto row = static_cast<ptrdiff_t>(3 * y * static_cast<size_t>(width));
        std::copy(right.values.begin() + row + static_cast<ptrdiff_t>(3 * from),
                  right.values.begin() + row + static_cast<ptrdiff_t>(3) * width,
                  left.values.begin() + row + static_cast<ptrdiff_t>(3 * from));
    }
}

void measure(Session& session)
{
    session.measures = session.scene_truth
                           ? compare_to_scene_truth(session.counted, *session.scene_truth, nullptr, session.gbuffer)
                           : compare_to_screen_truth(session.counted, *session.screen_truth);
    merge(session.measures, count_work(session.counted));
    session.stale.measures = false;
}

void compose(Session& session)
{
    const Display display{session.exposure_ev, Display::Transform::clip};
    if (session.show == "truth")
        session.shown = to_display(session.true_picture, display);
    else
        session.shown = session.show == "picture" ? to_display(session.shaded, display) : false_colours(session);
    if (session.split > 0) replace_right(session.shown, to_display(session.true_picture, display), session.split);
    session.stale.shown = false;
    ++session.version;
}

bool step(Session& session)
{
    Stale& stale = session.stale;
    if (stale.view)
        draw_view(session);
    else if (stale.trace)
        trace(session);
    else if (stale.truth)
        find_truth(session);
    else if (stale.measures)
        measure(session);
    else if (stale.answers && wants_answers(session))
        find_answers(session);
    else if (stale.true_picture && wants_true_picture(session))
        find_true_picture(session);
    else if (stale.shown)
        compose(session);
    else if (session.listed.empty() && session.times.size() < timed_frames &&
             spent_ms(session.times) < timing_budget_ms)
        session.times.push_back(run_frame(session.stage.gpu, *session.frame));
    else
        return false;
    return true;
}

} // namespace

std::unique_ptr<Session> open_session(const CommonOptions& common, const PictureOptions& picture)
{
    auto     opened                = std::make_unique<Session>();
    Session& session               = *opened;
    session.picture                = picture;
    const Catalogue catalogue      = load_catalogue(common.technique_dirs);
    const auto      asked          = asked_techniques(catalogue, picture.technique, picture.parameters);
    session.settings               = all_settings(catalogue);
    session.stage                  = open_stage(common, catalogue, picture);
    const auto [technique, choice] = choose_technique(session.stage, asked, common.quiet);
    session.choice                 = choice;
    session.technique              = &find_technique(session.stage.catalogue.techniques, technique->id);
    if (!camera_is_free(session)) return opened;
    session.bvh     = std::make_unique<SceneBvh>(session.stage.scene);
    session.camera  = camera_at(session.stage.scene, picture.view, picture.at);
    session.gbuffer = read_gbuffer(session.stage.gpu, *session.stage.gbuffer);
    aim(session);
    return opened;
}

bool camera_is_free(const Session& session) { return !session.stage.scene.frame; }

void set_value(Session& session, const std::string& name, const std::string& text)
{
    const std::string place = name + "=" + text;
    const auto        share = [&](double min, double max) {
        return parse_parameter(
                   {.name = name, .type = ParameterType::real, .min = min, .max = max, .choices = {}, .doc = {}}, text, place);
    };
    session.problem.clear();
    if (name == "technique") {
        session.technique     = &find_technique(session.stage.catalogue.techniques, text);
        session.choice.values = default_values(*session.technique);
        session.stale.trace   = true;
        return;
    }
    if (name == "sources") {
        if (!text.empty() && !session.bvh)
            throw_spec_error("{}: a frame of another renderer has no scene that sources could ask", place);
        session.listed      = text.empty() ? std::vector<ListedSource>{} : parse_sources(text, place);
        session.sources     = text;
        session.stale.trace = true;
        return;
    }
    if (name == "show" || name == "split" || name == "exposure") {
        if (name == "split") session.split = share(0, 1);
        if (name == "exposure") session.exposure_ev = share(-32, 32);
        if (name == "show") {
            const std::vector<std::string> known(shown_names.begin(), shown_names.end());
            if (std::ranges::find(known, text) == known.end())
                throw_spec_error("{}: {}", place, unknown_name("kind of picture", text, known));
            session.show = text;
        }
        session.stale.shown = true;
        return;
    }
    const FrameSettings before = session.choice.settings;
    set_choice(session.stage.catalogue, *session.technique, session.choice, place);
    session.stale.trace      = true;
    const FrameSettings& now = session.choice.settings;
    if (before.trace != now.trace) session.stale.truth = true;
    if (!same_scene_truth(before.trace, now.trace) ||
        metallic_exponent_of(before.passes) != metallic_exponent_of(now.passes))
        session.stale.true_picture = true;
}

void camera_changed(Session& session)
{
    session.problem.clear();
    session.camera_moved = true;
    session.stale        = {};
}

void aim(Session& session)
{
    const glm::ivec2 middle = session.stage.view.size_px / 2;
    const float      depth  = session.gbuffer.depth[pixel_index(middle, session.stage.view.size_px)];
    if (depth > 0) set_target_distance(session.camera, depth_to_distance(session.stage.view, depth));
}

bool has_answers(const Session& session) { return wants_answers(session) && !session.stale.answers; }

bool work(Session& session)
{
    if (!session.problem.empty()) return false;
    try {
        return step(session);
    } catch (const std::runtime_error& error) {
        session.problem = error.what();
        return false;
    }
}

} // namespace ssrlab
