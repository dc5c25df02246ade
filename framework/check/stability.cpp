#include "check/stability.h"

#include "check/depth_format.h"
#include "check/hard_case.h"
#include "check/run_check.h"
#include "core/error.h"
#include "core/quantile.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ssrlab {
namespace {

struct Answer {
    bool       hit = false;
    glm::ivec2 pixel{0};
    glm::dvec2 position_px{0};
};
using Answers = std::map<std::pair<int, int>, Answer>; // by pixel (y, x)

/// The answers of all mirror rays of a picture.
Answers answers_of(Gpu& gpu, const Catalogue& catalogue, const Technique& technique, const Setup& setup)
{
    const LabPtr lab    = make_lab(gpu, catalogue, upload_gbuffer(gpu, setup.gbuffer), technique,
                                   default_values(technique), setup.settings);
    const auto   tracer = make_tracer(gpu, lab, setup.gbuffer.depth.size());
    const auto   rays   = set_up_rays(gpu, *tracer);
    const auto   found  = trace_rays(gpu, *tracer, rays);
    Answers      answers;
    for (size_t i = 0; i < rays.size(); ++i)
        answers[{rays[i].pixel.y, rays[i].pixel.x}] = {
            found[i].status == TraceStatus::hit, found[i].hit_pixel,
            glm::dvec2(rays[i].origin_px_depth + found[i].t * rays[i].delta_px_depth)};
    return answers;
}

double quantile_or_0(const std::vector<double>& values, double p) { return values.empty() ? 0 : quantile(values, p); }

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

JitterRow measure_jitter(Gpu& gpu, const Catalogue& catalogue, const Technique& technique)
{
    const std::vector<Setup> phases = find_case("sub_pixel_jitter").setups();
    std::vector<Answers>     answers;
    for (const Setup& phase : phases) answers.push_back(answers_of(gpu, catalogue, technique, phase));

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
    row.median_spread_px = quantile_or_0(spreads, 0.5);
    row.p99_spread_px    = quantile_or_0(spreads, 0.99);
    return row;
}

namespace {

struct Tally {
    size_t              rays = 0, changed = 0;
    std::vector<double> moved_px, errors;
};

void compare(const Answers& exact, const Answers& imported, Tally& tally)
{
    for (const auto& [pixel, answer] : imported) {
        const auto before = exact.find(pixel);
        if (before == exact.end()) continue;
        ++tally.rays;
        const bool both = before->second.hit && answer.hit;
        if (both && before->second.pixel == answer.pixel) continue;
        tally.changed += both || before->second.hit != answer.hit;
        if (both) tally.moved_px.push_back(glm::distance(before->second.position_px, answer.position_px));
    }
}

/// Depth is near_m / distance.
void add_errors(const GBufferImage& exact, const GBufferImage& imported, std::vector<double>& errors)
{
    for (size_t i = 0; i < exact.depth.size(); ++i)
        if (exact.depth[i] > 0 && exact.depth[i] <= 1 && imported.depth[i] > 0)
            errors.push_back(
                std::abs(static_cast<double>(exact.depth[i]) / static_cast<double>(imported.depth[i]) - 1));
}

std::string percent(double part)
{
    return part < 0.01 ? fmt::format("{:.2g}", 100 * part) : fmt::format("{:.0f}", 100 * part);
}

bool is_deep(const GBufferImage& gbuffer)
{
    return std::ranges::any_of(gbuffer.depth,
                               [](float d) { return d > 0 && static_cast<double>(d) * deep_near_planes < 1; });
}

} // namespace

std::vector<FormatRow> measure_formats(Gpu& gpu, const Catalogue& catalogue, const Technique& technique)
{
    std::map<bool, std::vector<Tally>> tallies;
    for (const CaseFamily& family : hard_cases())
        for (const HardCase& hard_case : family.cases)
            for (const Setup& setup : hard_case.setups()) {
                if (!setup.rays.empty() || setup.gbuffer.view.projection != Projection::perspective) continue;
                std::vector<Tally>& of_group = tallies[is_deep(setup.gbuffer)];
                of_group.resize(depth_formats().size());
                const Answers exact = answers_of(gpu, catalogue, technique, setup);
                for (size_t f = 0; f < of_group.size(); ++f) {
                    const Setup imported = stored_and_imported(setup, depth_formats()[f]);
                    compare(exact, answers_of(gpu, catalogue, technique, imported), of_group[f]);
                    add_errors(setup.gbuffer, imported.gbuffer, of_group[f].errors);
                }
            }
    std::vector<FormatRow> rows;
    for (const auto& [deep, of_group] : tallies)
        for (size_t f = 0; f < of_group.size(); ++f)
            rows.push_back({depth_formats()[f].name, technique.id, deep, quantile_or_0(of_group[f].errors, 0.5),
                            quantile(of_group[f].errors, 0.99), of_group[f].rays,
                            per_million(of_group[f].changed, of_group[f].rays),
                            quantile_or_0(of_group[f].moved_px, 0.5)});
    return rows;
}

std::string stability_markdown(const std::vector<JitterRow>& jitter, const std::vector<FormatRow>& formats)
{
    std::string text = "\n## Jitter\n16 sub-pixel phases of a still camera. Flips: answers that differ from what the "
                       "pixel mostly says. Spread: standard deviation of a pixel's hit position; that of the pixel's "
                       "own centre is 0.4 px.\n\n| technique | pixels | flips % | spread median px | spread p99 px "
                       "|\n|---|--:|--:|--:|--:|\n";
    for (const JitterRow& row : jitter)
        text += fmt::format("| {} | {} | {:.3f} | {:.3f} | {:.3f} |\n", row.technique, row.pixels, row.flips_percent,
                            row.median_spread_px, row.p99_spread_px);

    text += fmt::format(
        "\n## Depth formats\nMirror rays of the perspective cases on depth that was stored in the format and "
        "imported, against the same technique on unrounded depth. Far plane: 1.5 times the farthest "
        "surface. Deep: that lies beyond {:.0f} near planes. Per technique: rays per million with "
        "another answer, and by how much hits moved on screen (median of those in another pixel; 0 on a border between "
        "two).\n\n| depth | format | rays "
        "| distance error, median % | p99 % |",
        deep_near_planes);
    std::map<std::pair<bool, std::string>, const FormatRow*> cells; // by deep and format + technique
    std::vector<std::string>                                 techniques;
    for (const FormatRow& row : formats) {
        cells[{row.deep, row.format + row.technique}] = &row;
        if (std::ranges::count(techniques, row.technique) == 0) techniques.push_back(row.technique);
    }
    for (const std::string& technique : techniques) text += fmt::format(" {} |", technique);
    text += "\n|---|---|--:|--:|--:|";
    for (size_t i = 0; i < techniques.size(); ++i) text += "--:|";
    for (const FormatRow& row : formats) {
        if (row.technique != techniques[0]) continue;
        text += fmt::format("\n| {} | {} | {} | {} | {} |", row.deep ? "deep" : "ordinary", row.format, row.rays,
                            percent(row.median_error), percent(row.p99_error));
        for (const std::string& technique : techniques) {
            const FormatRow& cell = *cells.at({row.deep, row.format + technique});
            text += fmt::format(" {:.0f}, {:.2f} px |", cell.changed_per_million, cell.median_moved_px);
        }
    }
    return text + "\n";
}

} // namespace ssrlab
