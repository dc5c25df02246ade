#include "check/judge_frame.h"

#include "check/judge.h"
#include "compare/validate_result.h"
#include "core/error.h"
#include "core/parallel_rows.h"
#include "truth/screen_truth.h"

#include <algorithm>
#include <cmath>

namespace ssrlab {
namespace {

/// How far a hit point may lie outside its pixel, by the rounding of its file.
constexpr double point_rounding_px = 0.01;
/// Of a coordinate that is stored as a float, relative.
constexpr double rounding_of_float = std::numeric_limits<float>::epsilon();
/// Answers whose t differs by less are the same; the file's t is a float.
constexpr double same_t = 1e-4;

/// A way of writing hits that a hit file does not have.
struct OtherConvention {
    const char* advice;
    bool        rows_from_bottom;
    glm::dvec2 (*to_px)(glm::dvec2 written, glm::dvec2 size_px);
    double tolerance_px = 1;
};

constexpr OtherConvention as_defined{"", false, [](glm::dvec2 at, glm::dvec2) { return at; }};
constexpr OtherConvention other_conventions[] = {
    {"hit.y seems to count from the bottom: expected 0 at the top of the image", false,
     [](glm::dvec2 at, glm::dvec2 size) { return glm::dvec2(at.x, size.y - at.y); }},
    {"the rows of the file seem to begin at the bottom: expected the top row first", true,
     [](glm::dvec2 at, glm::dvec2) { return at; }},
    {"the rows of the file and hit.y seem to count from the bottom: expected the top row first, and 0 at the top", true,
     [](glm::dvec2 at, glm::dvec2 size) { return glm::dvec2(at.x, size.y - at.y); }},
    {"hits seem to be shares of the image: expected pixels, 0 to its width and height", false,
     [](glm::dvec2 at, glm::dvec2 size) { return at * size; }},
    {"hits seem to be shares of the image from the bottom: expected pixels, with 0 at the top", false,
     [](glm::dvec2 at, glm::dvec2 size) { return glm::dvec2(at.x, 1 - at.y) * size; }},
    {"hits seem to have whole numbers at pixels' centres: expected (0.5, 0.5) at the centre of the first pixel", false,
     [](glm::dvec2 at, glm::dvec2) { return at + 0.5; }, 0.1}};

std::string text_of(TraceStatus status, glm::ivec2 pixel, double t)
{
    if (!has_place(status)) return std::string(status_name(status));
    return fmt::format("{} in ({}, {}) at t {:.6g}", status_name(status), pixel.x, pixel.y, t);
}

void require_known(const TraceSettings& settings)
{
    if (!has_screen_truth(settings.surface))
        throw_spec_error("surface = {}: known by its shaders alone, so nothing can be judged by it", settings.surface);
    if (settings.layers > 1)
        throw_spec_error("layers = {}: a frame file holds the first layer alone; expected 1", settings.layers);
}

class FrameJudge {
public:
    FrameJudge(const GBufferImage& gbuffer, const TraceSettings& settings, const HitsFile& hits)
        : setup_{"", gbuffer, settings, {}}, judge_(setup_), hits_(hits), truth_(screen_truth(gbuffer, settings))
    {
        judgement_.usable = hits.result;
        faults_.resize(truth_.status.size());
    }

    FrameJudgement run()
    {
        const glm::ivec2 size = truth_.size_px;
        parallel_rows(size.y, 0, [&](int y) {
            for (int x = 0; x < size.x; ++x) judge_pixel(pixel_index({x, y}, size));
        });
        for (size_t i = 0; i < faults_.size(); ++i) {
            if (truth_.status[i] == TraceStatus::not_traced) {
                judgement_.ignored += hits_.has_status && hits_.result.status[i] != TraceStatus::not_traced;
                continue;
            }
            ++judgement_.rays;
            ++judgement_.count[static_cast<size_t>(faults_[i].fault)];
            if (faults_[i].fault > Fault::near_tie) judgement_.findings.push_back(std::move(faults_[i]));
        }
        advise();
        return std::move(judgement_);
    }

private:
    struct Agreement {
        size_t hits = 0, near = 0; // rays that hit in the file and truly; of them those near the right point
    };

    Agreement agreement(const OtherConvention& convention, double tolerance_px) const
    {
        const glm::ivec2 size = truth_.size_px;
        Agreement        found;
        for (size_t i = 0; i < truth_.status.size(); ++i) {
            glm::ivec2 pixel = pixel_at(i, size);
            if (convention.rows_from_bottom) pixel.y = size.y - 1 - pixel.y;
            const size_t in_frame = pixel_index(pixel, size);
            if (hits_.result.status[i] != TraceStatus::hit || truth_.status[in_frame] != TraceStatus::hit) continue;
            const glm::dvec2 written = hits_.has_point ? glm::dvec2(hits_.result.hit_px_depth[i])
                                                       : glm::dvec2(hits_.result.hit_pixel[i]) + 0.5;
            const glm::dvec2 off     = convention.to_px(written, size) - glm::dvec2(truth_.hit_px_depth[in_frame]);
            ++found.hits;
            found.near += glm::length(off) <= tolerance_px;
        }
        return found;
    }

    /// Names a convention under which most hits are near the right ones, and twice as many as without it.
    void advise()
    {
        if (judgement_.wrong() == 0) return;
        for (const OtherConvention& other : other_conventions) {
            const Agreement so = agreement(other, other.tolerance_px);
            if (2 * so.near > so.hits && so.near > 2 * agreement(as_defined, other.tolerance_px).near)
                judgement_.advice.emplace_back(other.advice);
        }
    }

    void judge_pixel(size_t i)
    {
        TraceImage&      result = judgement_.usable;
        const glm::ivec2 pixel  = pixel_at(i, truth_.size_px);
        if (truth_.status[i] == TraceStatus::not_traced) {
            result.status[i] = TraceStatus::not_traced;
            return;
        }
        const ScreenRay screen_ray = make_screen_ray(setup_.gbuffer, pixel, setup_.settings);
        const RayInput  ray{screen_ray.origin_px_depth, screen_ray.delta_px_depth, screen_ray.length_m,
                           screen_ray.end_status, pixel};
        complete(i, ray);
        Finding& found = faults_[i];
        found          = {pixel, Fault::right, text_of(truth_.status[i], truth_.hit_pixel[i], truth_.hit_t[i]),
                          text_of(result.status[i], result.hit_pixel[i], result.hit_t[i]), ""};
        found.why      = impossible_here(i, ray);
        if (!found.why.empty()) {
            found.fault      = Fault::impossible;
            found.got        = found.why;
            found.why        = "";
            result.status[i] = ray.end_status;
            result.steps[i]  = 0;
            return;
        }
        if (result.status[i] == TraceStatus::not_traced) {
            found.fault = Fault::unanswered;
            return;
        }
        judge_answer(i, ray, found);
    }

    /// Fills in what the file leaves out.
    void complete(size_t i, const RayInput& ray)
    {
        TraceImage& result = judgement_.usable;
        if (!hits_.has_status && result.status[i] != TraceStatus::hit)
            result.status[i] = truth_.status[i] == TraceStatus::hit ? ray.end_status : truth_.status[i];
        if (!has_place(result.status[i])) return;
        const glm::dvec3 from = ray.origin_px_depth, along = ray.delta_px_depth;
        if (!hits_.has_pixel) result.hit_pixel[i] = entered_pixel(result.hit_px_depth[i], along, result.hit_pixel[i]);
        if (!hits_.has_t) {
            const glm::dvec2 at =
                hits_.has_point ? glm::dvec2(result.hit_px_depth[i]) : glm::dvec2(result.hit_pixel[i]) + 0.5;
            const glm::dvec2 way(along);
            const double     length_2 = glm::dot(way, way);
            double           t        = length_2 > 0 ? glm::dot(at - glm::dvec2(from), way) / length_2 : 0;
            t                         = std::clamp(t, 0.0, 1.0);
            for (const Visit& visit : judge_.walk(ray))
                if (visit.pixel == result.hit_pixel[i]) t = std::clamp(t, visit.t_in, visit.t_out);
            result.hit_t[i] = t;
        }
        const glm::dvec3 on_ray = from + result.hit_t[i] * along;
        if (!hits_.has_point) result.hit_px_depth[i] = glm::dvec3(on_ray.x, on_ray.y, result.hit_px_depth[i].z);
        if (!hits_.has_z) result.hit_px_depth[i].z = on_ray.z;
    }

    /// The pixel of a point; on a border the one that the ray enters there.
    static glm::ivec2 entered_pixel(glm::dvec2 point, glm::dvec2 along, glm::ivec2 pixel)
    {
        for (int axis = 0; axis < 2; ++axis) {
            const double border = std::round(point[axis]);
            if (std::abs(point[axis] - border) <= border * rounding_of_float && along[axis] != 0)
                pixel[axis] = static_cast<int>(border) - (along[axis] < 0 ? 1 : 0);
        }
        return pixel;
    }

    RayOutcome outcome_of(size_t i) const
    {
        const TraceImage& result = judgement_.usable;
        return {result.status[i],
                result.hit_pixel[i],
                has_place(result.status[i]) ? result.hit_t[i] : 0,
                result.steps[i],
                0,
                0,
                result.hit_layer[i]};
    }

    std::string impossible_here(size_t i, const RayInput& ray) const
    {
        const TraceImage& result = judgement_.usable;
        const glm::dvec3  point  = result.hit_px_depth[i];
        const glm::ivec2  pixel  = result.hit_pixel[i];
        if (result.status[i] == TraceStatus::not_traced) return "";
        if (has_place(result.status[i]) && !(std::isfinite(point.x) && std::isfinite(point.y)))
            return fmt::format("hit at ({}, {}), which are no numbers", point.x, point.y);
        const Answer answer{result.status[i], pixel, result.hit_t[i], result.steps[i]};
        if (std::string what = impossible(answer, truth_.size_px, std::numeric_limits<double>::infinity());
            !what.empty())
            return what;
        if (!has_place(result.status[i])) return "";
        if (result.hit_layer[i] > 0) return fmt::format("hit in layer {}, and the frame has one", result.hit_layer[i]);
        const glm::dvec2 off = glm::abs(glm::dvec2(point) - (glm::dvec2(pixel) + 0.5)) - 0.5;
        if (std::max(off.x, off.y) > point_rounding_px)
            return fmt::format("hit at ({:.6g}, {:.6g}), which is not in its pixel ({}, {})", point.x, point.y, pixel.x,
                               pixel.y);
        return judge_.broken_invariant(ray, outcome_of(i));
    }

    void judge_answer(size_t i, const RayInput& ray, Finding& found) const
    {
        const TraceImage& result = judgement_.usable;
        const bool        hit = result.status[i] == TraceStatus::hit, hits_truly = truth_.status[i] == TraceStatus::hit;
        const bool        same_end = result.status[i] == truth_.status[i];
        if (same_end && !has_place(truth_.status[i])) return;
        const bool same_place = same_end && result.hit_pixel[i] == truth_.hit_pixel[i];
        if (same_place && (!hits_.has_t || std::abs(result.hit_t[i] - truth_.hit_t[i]) < same_t)) return;
        const auto plain_end = [](TraceStatus status) {
            return status == TraceStatus::left_screen || status == TraceStatus::past_max_distance;
        };
        if (plain_end(result.status[i]) && plain_end(truth_.status[i])) {
            found.fault = Fault::other_end;
            return;
        }
        const Judgement verdict = judge_.judge(ray, outcome_of(i), Claim{});
        if (verdict.verdict == Verdict::right) return;
        found.why = verdict.reason;
        if (verdict.verdict == Verdict::sliver)
            found.fault = Fault::near_tie;
        else if (result.status[i] == TraceStatus::out_of_steps)
            found.fault = Fault::out_of_steps;
        else if (hit != hits_truly)
            found.fault = hit ? Fault::false_hit : Fault::missed;
        else if (!hit)
            found.fault = Fault::other_end;
        else
            found.fault = result.hit_t[i] < truth_.hit_t[i] ? Fault::too_early : Fault::too_late;
    }

    const Setup          setup_;
    const Judge          judge_;
    const HitsFile&      hits_;
    const TraceImage     truth_;
    std::vector<Finding> faults_; // one per pixel
    FrameJudgement       judgement_;
};

} // namespace

FrameJudgement judge_frame(const GBufferImage& gbuffer, const TraceSettings& settings, const HitsFile& hits)
{
    require_known(settings);
    return FrameJudge(gbuffer, settings, hits).run();
}

} // namespace ssrlab
