#include "check/stability.h"

#include "check/depth_format.h"
#include "check/hard_case.h"
#include "check/run_check.h"
#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ssrlab {
namespace {

struct Answer {
    bool       hit = false;
    glm::dvec2 position_px{0};
};
using Answers = std::map<std::pair<int, int>, Answer>; // by pixel (y, x)

/// The answers of all mirror rays of a picture.
Answers answers_of(Gpu& gpu, const Technique& technique, const Setup& setup)
{
    const auto tracer = make_ray_tracer(gpu, upload_gbuffer(gpu, setup.gbuffer), technique, default_values(technique),
                                        setup.settings, setup.gbuffer.depth.size());
    const auto rays   = set_up_rays(gpu, *tracer);
    const auto found  = trace_rays(gpu, *tracer, rays);
    Answers    answers;
    for (size_t i = 0; i < rays.size(); ++i)
        answers[{rays[i].pixel.y, rays[i].pixel.x}] = {
            found[i].status == TraceStatus::hit,
            glm::dvec2(rays[i].origin_px_depth + found[i].t * rays[i].delta_px_depth)};
    return answers;
}

/// 0 for an empty list.
double quantile(std::vector<double> values, double q)
{
    if (values.empty()) return 0;
    std::ranges::sort(values);
    return values[std::min(values.size() - 1, static_cast<size_t>(q * static_cast<double>(values.size())))];
}

double standard_deviation(const std::vector<glm::dvec2>& points)
{
    glm::dvec2 mean(0);
    for (const glm::dvec2& p : points) mean += p / static_cast<double>(points.size());
    double sum = 0;
    for (const glm::dvec2& p : points) sum += glm::dot(p - mean, p - mean);
    return std::sqrt(sum / static_cast<double>(points.size()));
}

double per_million(size_t n, size_t of) { return of == 0 ? 0 : 1e6 * static_cast<double>(n) / static_cast<double>(of); }

} // namespace

JitterRow measure_jitter(Gpu& gpu, const Technique& technique)
{
    const std::vector<Setup> phases = find_case("sub_pixel_jitter").setups();
    std::vector<Answers>     answers;
    for (const Setup& phase : phases) answers.push_back(answers_of(gpu, technique, phase));

    JitterRow           row{.technique = technique.id};
    size_t              flips = 0;
    std::vector<double> spreads;
    for (const auto& [pixel, first] : answers[0]) {
        std::vector<glm::dvec2> hits;
        size_t                  traced = 0;
        for (size_t i = 0; i < phases.size(); ++i) {
            const auto answer = answers[i].find(pixel);
            if (answer == answers[i].end()) continue;
            ++traced;
            // Where the hit would be without the phase's shift.
            const glm::dvec2 shift =
                phases[i].gbuffer.view.centre_px - 0.5 * glm::dvec2(phases[i].gbuffer.view.size_px);
            if (answer->second.hit) hits.push_back(answer->second.position_px - shift);
        }
        if (traced < phases.size()) continue;
        ++row.pixels;
        flips += std::min(hits.size(), traced - hits.size());
        if (hits.size() > 1) spreads.push_back(standard_deviation(hits));
    }
    row.flips_percent    = 1e-4 * per_million(flips, row.pixels * phases.size());
    row.median_spread_px = quantile(spreads, 0.5);
    row.p99_spread_px    = quantile(spreads, 0.99);
    return row;
}

std::vector<FormatRow> measure_formats(Gpu& gpu, const Technique& technique)
{
    struct Tally {
        size_t              rays = 0, changed = 0, moved = 0;
        std::vector<double> distances_px;
    };
    std::vector<Tally> tallies(depth_formats().size());
    for (const CaseFamily& family : hard_cases())
        for (const HardCase& hard_case : family.cases)
            for (const Setup& setup : hard_case.setups()) {
                if (!setup.rays.empty() || setup.gbuffer.view.projection != Projection::perspective) continue;
                const Answers exact = answers_of(gpu, technique, setup);
                for (size_t f = 0; f < tallies.size(); ++f) {
                    const Setup imported = stored_and_imported(setup, depth_formats()[f]);
                    for (const auto& [pixel, answer] : answers_of(gpu, technique, imported)) {
                        const auto before = exact.find(pixel);
                        if (before == exact.end()) continue;
                        ++tallies[f].rays;
                        tallies[f].changed += before->second.hit != answer.hit;
                        if (!before->second.hit || !answer.hit) continue;
                        const double moved = glm::distance(before->second.position_px, answer.position_px);
                        if (glm::ivec2(before->second.position_px) == glm::ivec2(answer.position_px)) continue;
                        ++tallies[f].moved;
                        tallies[f].distances_px.push_back(moved);
                    }
                }
            }
    std::vector<FormatRow> rows;
    for (size_t f = 0; f < tallies.size(); ++f)
        rows.push_back({depth_formats()[f].name, technique.id, tallies[f].rays,
                        per_million(tallies[f].changed, tallies[f].rays),
                        per_million(tallies[f].moved, tallies[f].rays), quantile(tallies[f].distances_px, 0.5),
                        quantile(tallies[f].distances_px, 0.99)});
    return rows;
}

std::string stability_markdown(const std::vector<JitterRow>& jitter, const std::vector<FormatRow>& formats)
{
    std::string text = "\n## Jitter\n16 sub-pixel phases of a still camera. Flips: answers that differ from what the "
                       "pixel mostly says. Spread: standard deviation of a "
                       "pixel's hit position.\n\n| technique | pixels | flips % | spread median px | spread p99 px "
                       "|\n|---|--:|--:|--:|--:|\n";
    for (const JitterRow& row : jitter)
        text += fmt::format("| {} | {} | {:.3f} | {:.3f} | {:.3f} |\n", row.technique, row.pixels, row.flips_percent,
                            row.median_spread_px, row.p99_spread_px);
    text += "\n## Depth formats\nMirror rays of all perspective cases on depth that was stored in the format and "
            "imported, against the unrounded depth. "
            "Far plane: 1.5 times the farthest surface.\n\n| format | technique | rays | hit/miss changed per million "
            "| hit pixel moved per million | moved median px | moved p99 px |\n"
            "|---|---|--:|--:|--:|--:|--:|\n";
    for (const FormatRow& row : formats)
        text +=
            fmt::format("| {} | {} | {} | {:.0f} | {:.0f} | {:.3f} | {:.3f} |\n", row.format, row.technique, row.rays,
                        row.changed_per_million, row.moved_per_million, row.median_moved_px, row.p99_moved_px);
    return text;
}

} // namespace ssrlab
