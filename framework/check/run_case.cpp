#include "check/run_case.h"

#include "check/ray_report.h"
#include "core/error.h"
#include "core/stopwatch.h"
#include "shared.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace ssrlab {
namespace {

constexpr size_t most_findings = 4;

/// A setup on the device, with its rays as the tracer gets them.
struct Placed {
    Setup     setup;
    TracerPtr tracer;
};

Placed put_on_device(Gpu& gpu, const Catalogue& catalogue, const Technique& technique, const ParameterValues& values,
                     Setup setup, NumberFormat number_format = NumberFormat::float32)
{
    const size_t pixels   = setup.gbuffer.depth.size();
    const size_t capacity = setup.rays.empty() ? pixels : setup.rays.size();
    if (std::ranges::count(technique.ignores, "behind") > 0) setup.settings.behind = Behind::hit; // and is judged so
    Placed       placed{std::move(setup), nullptr};
    const LabPtr lab =
        make_lab(gpu, catalogue, upload_gbuffer(gpu, placed.setup.gbuffer), technique, values, placed.setup.settings);
    placed.tracer = make_tracer(gpu, lab, capacity, number_format);
    if (placed.setup.rays.empty()) placed.setup.rays = set_up_rays(gpu, *placed.tracer);
    return placed;
}

bool same_answer(const RayOutcome& a, const RayOutcome& b, bool compare_t)
{
    if (a.status != b.status) return false;
    if (!has_place(a.status)) return true;
    return a.hit_pixel == b.hit_pixel && (!compare_t || a.t == b.t);
}

std::string text(const RayOutcome& outcome)
{
    if (!has_place(outcome.status)) return std::string(status_name(outcome.status));
    return fmt::format("{} ({}, {}) t {:.9g}", status_name(outcome.status), outcome.hit_pixel.x, outcome.hit_pixel.y,
                       outcome.t);
}

/// Without what the closed form leaves open.
std::string text(const Expected& expected)
{
    std::string words(status_name(*expected.status));
    if (!has_place(*expected.status)) return words;
    if (expected.pixel) words += fmt::format(" ({}, {})", expected.pixel->x, expected.pixel->y);
    if (expected.t) words += fmt::format(" t {:.9g}", *expected.t);
    return words;
}

void add_to_digest(uint64_t& digest, const RayOutcome& outcome)
{
    const bool ends   = has_place(outcome.status);
    uint64_t   t_bits = 0;
    std::memcpy(&t_bits, &outcome.t, sizeof(t_bits));
    const uint64_t pixel =
        static_cast<uint64_t>(outcome.hit_pixel.x) << 32 | static_cast<uint64_t>(outcome.hit_pixel.y);
    for (const uint64_t word : {static_cast<uint64_t>(outcome.status), ends ? pixel : 0, ends ? t_bits : 0,
                                static_cast<uint64_t>(outcome.steps)})
        digest = (digest ^ word) * 0x100000001b3ULL;
}

/// One run of one technique on one case; collects the row.
class CaseRun {
public:
    CaseRun(Gpu& gpu, const Catalogue& catalogue, const Technique& technique, const ParameterValues& values,
            const HardCase& hard_case, CaseRow& row)
        : gpu_(gpu), catalogue_(catalogue), technique_(technique), values_(adjusted(hard_case, technique, values)),
          case_(hard_case), row_(row)
    {
    }

    void run(const CheckOptions& options)
    {
        const std::vector<Setup> setups = case_.setups();
        for (setup_index_ = 0; setup_index_ < setups.size(); ++setup_index_) {
            label_                  = setups[setup_index_].label;
            Placed         placed   = put_on_device(gpu_, catalogue_, technique_, values_, setups[setup_index_]);
            const Outcomes outcomes = trace_rays(gpu_, *placed.tracer, placed.setup.rays);
            judge_rays(placed.setup, outcomes);
            if (trace_rays(gpu_, *placed.tracer, placed.setup.rays) != outcomes)
                report(0, "a second run gives other bits");
            compare_mirrored(placed, outcomes);
            if (technique_.exact)
                for (const Relation& relation : case_.relations)
                    compare_related(setups[setup_index_], outcomes, relation);
            if (options.double_precision && gpu_.info.float64) compare_precision(placed.setup, outcomes);
        }
    }

private:
    using Outcomes = std::vector<RayOutcome>;

    void report(size_t ray, const std::string& what)
    {
        ++row_.breaks;
        if (row_.findings.size() < most_findings)
            row_.findings.push_back(
                fmt::format("{}{}ray {}:{}: {}", label_, label_.empty() ? "" : ", ", setup_index_, ray, what));
    }

    double stated_bound() const { return declared_steps(technique_, values_); }

    uint32_t step_bound(const Setup& setup) const
    {
        const double stated = stated_bound();
        if (!technique_.exact) return static_cast<uint32_t>(stated);
        // Two cells for each pixel that the ray may cross, and those below the level at which it begins.
        double proven = 2.0 * (setup.gbuffer.view.size_px.x + setup.gbuffer.view.size_px.y - 1) + PIXEL_BITS;
        if (case_.most_steps) proven = std::min(proven, static_cast<double>(case_.most_steps(setup)));
        return static_cast<uint32_t>(std::min(stated, proven));
    }

    void judge_rays(const Setup& setup, const Outcomes& outcomes)
    {
        const Judge    judge(setup);
        const Claim    claim = claim_of(technique_);
        const uint32_t bound = step_bound(setup);
        row_.rays += outcomes.size();
        for (size_t i = 0; i < outcomes.size(); ++i) {
            const RayOutcome& outcome = outcomes[i];
            add_to_digest(row_.digest, outcome);
            row_.non_finite += !std::isfinite(outcome.t);
            row_.out_of_steps += outcome.status == TraceStatus::out_of_steps;
            row_.most_steps = std::max(row_.most_steps, outcome.steps);
            check_set_up(setup, i);
            if (const std::string broken = judge.broken_invariant(setup.rays[i], outcome); !broken.empty()) {
                report(i, broken);
                continue;
            }
            if (outcome.steps > bound)
                report(i, fmt::format("{} iterations, at most {} are proven", outcome.steps, bound));
            if (outcome.status == TraceStatus::out_of_steps && outcome.steps >= stated_bound())
                continue; // a budget that the user chose
            if (outcome.status == TraceStatus::out_of_steps && technique_.exact)
                report(i, "out of steps within its budget");
            check_expected(setup, i, outcome);
            const Judgement verdict = judge.judge(setup.rays[i], outcome, claim);
            row_.findable += verdict.findable;
            row_.found += verdict.found;
            row_.slivers += verdict.verdict == Verdict::sliver;
            row_.allowed += verdict.verdict == Verdict::allowed;
            if (verdict.verdict != Verdict::sliver)
                row_.worst_deviation_px = std::max(row_.worst_deviation_px, verdict.deviation_px);
            if (verdict.verdict != Verdict::wrong) continue;
            ++row_.wrong;
            report(i, verdict.reason);
        }
    }

    void check_set_up(const Setup& setup, size_t i)
    {
        const RayInput&  ray = setup.rays[i];
        const glm::dvec2 end(ray.origin_px_depth + ray.delta_px_depth), size(setup.gbuffer.view.size_px);
        bool             sound = ray.length_m >= 0;
        for (int axis : {0, 1}) sound = sound && end[axis] >= -1e-3 && end[axis] <= size[axis] + 1e-3;
        if (!sound) report(i, fmt::format("set up to end at ({}, {}), length {} m", end.x, end.y, ray.length_m));
    }

    void check_expected(const Setup& setup, size_t i, const RayOutcome& outcome)
    {
        if (!case_.expected) return;
        const std::optional<Expected> expected = case_.expected(setup, setup.rays[i]);
        if (!expected) return;
        const glm::dvec2 end(setup.rays[i].origin_px_depth + setup.rays[i].delta_px_depth);
        if (expected->end_px && !(glm::distance(end, *expected->end_px) < 1e-3))
            report(i, fmt::format("set up to end at ({:.6f}, {:.6f}), expected ({:.6f}, {:.6f})", end.x, end.y,
                                  expected->end_px->x, expected->end_px->y));
        if (!technique_.exact || !expected->status) return; // the judge allows for a technique's limits
        const bool pixel_right = !expected->pixel || outcome.hit_pixel == *expected->pixel;
        const bool t_right     = !expected->t || std::abs(outcome.t - *expected->t) < 1e-4;
        if (outcome.status == expected->status && (!has_place(outcome.status) || (pixel_right && t_right))) return;
        report(i, fmt::format("{}, but the closed form says {}", text(outcome), text(*expected)));
    }

    /// Techniques that sample may see a sample on a pixel's border fall to the other side: they are held to a right answer, not to the same.
    void compare_mirrored(Placed& placed, const Outcomes& outcomes)
    {
        for (int axis : {0, 1}) {
            const Setup other = mirrored(placed.setup, axis);
            replace_picture(gpu_, *placed.tracer, other.gbuffer);
            const Outcomes answers = trace_rays(gpu_, *placed.tracer, other.rays);
            const Judge    judge(other);
            for (size_t i = 0; i < answers.size(); ++i) {
                if (!mirrors_exactly(placed.setup.rays[i], placed.setup.gbuffer.view.size_px, axis)) continue;
                const RayOutcome back = mirrored(answers[i], placed.setup.gbuffer.view.size_px, axis);
                if (same_answer(back, outcomes[i], true)) continue;
                if (technique_.exact)
                    report(i, fmt::format("{}, but its mirror image in {} says {}", text(outcomes[i]),
                                          axis == 0 ? "x" : "y", text(back)));
                else if (judge.judge(other.rays[i], answers[i], claim_of(technique_)).verdict == Verdict::wrong)
                    report(i,
                           fmt::format("its mirror image in {} is wrong: {}", axis == 0 ? "x" : "y", text(answers[i])));
            }
        }
    }

    void compare_related(const Setup& setup, const Outcomes& outcomes, const Relation& relation)
    {
        const Placed   placed  = put_on_device(gpu_, catalogue_, technique_, values_, relation.change(setup));
        const Outcomes answers = trace_rays(gpu_, *placed.tracer, placed.setup.rays);
        if (answers.size() != outcomes.size()) {
            report(0, fmt::format("{}: {} rays became {}", relation.name, outcomes.size(), answers.size()));
            return;
        }
        for (size_t i = 0; i < answers.size(); ++i) {
            const RayOutcome back = has_place(answers[i].status) ? relation.back(answers[i]) : answers[i];
            if (!same_answer(back, outcomes[i], relation.compare_t))
                report(i, fmt::format("{}, but {}: {}", text(outcomes[i]), relation.name, text(back)));
        }
    }

    void compare_precision(const Setup& setup, const Outcomes& outcomes)
    {
        const Placed   placed  = put_on_device(gpu_, catalogue_, technique_, values_, setup, NumberFormat::float64);
        const Outcomes answers = trace_rays(gpu_, *placed.tracer, placed.setup.rays);
        for (size_t i = 0; i < answers.size(); ++i)
            row_.precision_changes += !same_answer(answers[i], outcomes[i], false);
    }

    Gpu&             gpu_;
    const Catalogue& catalogue_;
    const Technique& technique_;
    ParameterValues  values_;
    const HardCase&  case_;
    CaseRow&         row_;
    std::string      label_;
    size_t           setup_index_ = 0;
};

} // namespace

CaseRow run_case(Gpu& gpu, const Catalogue& catalogue, const Technique& technique, const ParameterValues& values,
                 const std::string& family, const HardCase& hard_case, const CheckOptions& options)
{
    CaseRow row;
    row.family    = family;
    row.case_name = hard_case.name;
    row.technique = technique.id;
    const Stopwatch stopwatch;
    CaseRun(gpu, catalogue, technique, values, hard_case, row).run(options);
    row.seconds = stopwatch.seconds();
    return row;
}

uint64_t digest_of(Gpu& gpu, const Catalogue& catalogue, const Technique& technique, const ParameterValues& values,
                   const HardCase& hard_case)
{
    const ParameterValues adjusted_values = adjusted(hard_case, technique, values);
    uint64_t              digest          = 0;
    for (Setup& setup : hard_case.setups()) {
        const Placed placed = put_on_device(gpu, catalogue, technique, adjusted_values, std::move(setup));
        for (const RayOutcome& outcome : trace_rays(gpu, *placed.tracer, placed.setup.rays))
            add_to_digest(digest, outcome);
    }
    return digest;
}

std::string describe_ray(Gpu& gpu, const Catalogue& catalogue, const Technique& technique,
                         const ParameterValues& values, const HardCase& hard_case, size_t setup_index, size_t ray_index)
{
    std::vector<Setup> setups = hard_case.setups();
    if (setup_index >= setups.size())
        throw_spec_error("case '{}' has {} setups, numbered from 0", hard_case.name, setups.size());
    const Placed placed = put_on_device(gpu, catalogue, technique, values, setups[setup_index]);
    if (ray_index >= placed.setup.rays.size())
        throw_spec_error("setup {} of '{}' has {} rays, numbered from 0", setup_index, hard_case.name,
                         placed.setup.rays.size());
    const RayInput   ray     = placed.setup.rays[ray_index];
    const RayOutcome outcome = trace_rays(gpu, *placed.tracer, std::span(&ray, 1))[0];
    const Judge      judge(placed.setup);
    std::string      out = fmt::format("{} ({})\nray {}:{} of pixel ({}, {}): from ({:.9g}, {:.9g}) depth {:.9g} by "
                                            "({:.9g}, {:.9g}) depth {:.9g}, {:.9g} m\n",
                                       hard_case.name, hard_case.breaks, setup_index, ray_index, ray.pixel.x, ray.pixel.y,
                                       ray.origin_px_depth.x, ray.origin_px_depth.y, ray.origin_px_depth.z,
                                       ray.delta_px_depth.x, ray.delta_px_depth.y, ray.delta_px_depth.z, ray.length_m);
    for (const Visit& v : judge.walk(ray))
        out += fmt::format(
            "  ({:5}, {:5})  t {:.9f} … {:.9f}  depth {:.9f} … {:.9f}  slab {:.9f} … {:.9f}  {:.4f} px inside{}\n",
            v.pixel.x, v.pixel.y, v.t_in, v.t_out, v.z_in, v.z_out, v.surface.front, v.surface.back,
            depth_inside_px(ray, v), v.contact >= 0 ? "  touches" : "");
    out += fmt::format("{}: {} after {} iterations\nexactly: {}\n", technique.id, text(outcome), outcome.steps,
                       text(judge.exact_answer(ray)));
    const RayQuestion question{&technique, values};
    const RayReport   report = report_ray(gpu, catalogue, placed.setup, ray, std::span(&question, 1));
    out += visits_table(report.techniques.front());
    const std::string broken  = judge.broken_invariant(ray, outcome);
    const Judgement   verdict = judge.judge(ray, outcome, claim_of(technique));
    return out + (broken.empty() ? verdict.reason.empty() ? "right, or within what it claims\n" : verdict.reason + "\n"
                                 : broken + "\n");
}

} // namespace ssrlab
