// Each assumption of the proof (docs/explanation/exactness.md), broken once: the campaign or the catalogue must notice.
#include "check/run_check.h"
#include "core/files.h"
#include "gpu/device.h"
#include "gpu/shader.h"
#include "hard_cases/random_rays.h"

namespace ssrlab::test {
namespace {

namespace fs = std::filesystem;

/// A copy of an in-tree technique with one text replaced, in a folder that lives as long as the test.
class Mutant {
public:
    Mutant(const std::string& id, const std::string& from, const std::string& to)
    {
        std::string pattern = (fs::temp_directory_path() / "mutant.XXXXXX").string();
        folder_             = ::mkdtemp(pattern.data());
        fs::copy(technique(id).folder, folder_ / "mutant", fs::copy_options::recursive);
        const fs::path file = folder_ / "mutant/trace.glsl";
        std::string    text = read_file(file);
        replace_in(text, "#include \"api/forward_traversal.glsl\"",
                   read_file(shader_folder() / "api/forward_traversal.glsl"));
        if (!replace_in(text, from, to)) throw std::logic_error("mutation: '" + from + "' is not in " + id);
        write_file_atomically(file, text);
        mutant_ = load_technique(folder_ / "mutant", catalogue().structures);
    }
    ~Mutant() { fs::remove_all(folder_); }
    Mutant(const Mutant&)                     = delete;
    Mutant&          operator=(const Mutant&) = delete;
    const Technique& operator*() const { return mutant_; }

private:
    static bool replace_in(std::string& text, const std::string& from, const std::string& to)
    {
        const size_t at = text.find(from);
        if (at == std::string::npos) return false;
        text.replace(at, from.size(), to);
        return true;
    }

    fs::path  folder_;
    Technique mutant_;
};

struct Mutation {
    std::string name;
    std::string technique, from, to;
    std::string seen_in; // a hard case; empty: the campaign against the pixel walk
};

void PrintTo(const Mutation& mutation, std::ostream* out) { *out << mutation.name; }

/// A function put before the technique's own, and a name that then stands for it.
Mutation replaced(const std::string& name, const std::string& function, const std::string& text,
                  const std::string& seen_in = {}, const std::string& id = "hiz")
{
    const std::string api = "#include \"api/test_pixel.glsl\"\n#include \"api/box.glsl\"\n"
                            "#include \"api/depth_interval.glsl\"\n";
    return {name, id, "", api + text + "\n#define " + function + " mutated_" + function + "\n", seen_in};
}

std::vector<Mutation> mutations()
{
    return {
        replaced("PyramidSizesRoundedDown", "test_cell",
                 "Contact mutated_test_cell(Ray ray, Grid grid, ivec2 pixel, int level, uvec2 words, real a, real b) { "
                 "if (any(greaterThanEqual(pixel >> level, max(size_px >> level, ivec2(1))))) return no_contact(); "
                 "return test_cell(ray, grid, pixel, level, words, a, b); }",
                 "last_row_and_column"),
        replaced("DepthByMix", "test_cell",
                 "real mixed(Ray ray, real t) { real end = ray.origin.z + ray.delta.z; precise real z = "
                 "ray.origin.z * (real(1) - t) + end * t; return z; }\n"
                 "Contact mutated_test_cell(Ray ray, Grid grid, ivec2 pixel, int level, uvec2 words, real a, real b) { "
                 "Contact c = test_cell(ray, grid, pixel, level, words, a, b); if (level == 0) c.found = "
                 "interval_touches(depth_in(words, pixel), depth_interval(ray, mixed(ray, a), mixed(ray, b))); "
                 "return c; }",
                 "level_at_the_surface"),
        replaced("BordersMultipliedOut", "border_t",
                 "real2 mutated_border_t(Ray ray, Grid grid, ivec2 border) { return real2(border) * grid.inverse_delta "
                 "- ray.origin.xy * grid.inverse_delta; }"),
        // These two concern the pixel walk.
        replaced("BordersByDivision", "border_t",
                 "real2 mutated_border_t(Ray ray, Grid grid, ivec2 border) { return (real2(border) - ray.origin.xy) / "
                 "ray.delta.xy; }",
                 "axis_aligned", "dda"),
        replaced("MinusZeroIsInfinite", "make_grid",
                 "Grid mutated_make_grid(Ray ray) { Grid g = make_grid(ray); g.inverse_delta = real2(1) / "
                 "ray.delta.xy; g.forward = ivec2(greaterThan(ray.delta.xy, real2(0))); return g; }",
                 "signed_zero", "dda"),
        {"LessForLessOrEqualAtCorners", "hiz_packets",
         "return mix(corner, corner + size, lessThanEqual(t_border, real2(t)));",
         "bool x = t_border.x <= t; return corner + size * ivec2(x, !x);", "exact_diagonal"},
        {"LessForLessOrEqualAtChildren",
         "hiz_packets",
         "lessThanEqual(border_t(ray, grid, middle), real2(t))",
         "lessThan(border_t(ray, grid, middle), real2(t))",
         {}},
        {"LessForLessOrEqualBelow", "hiz", "bvec2 beyond = lessThanEqual(", "bvec2 beyond = lessThan(", {}},
        {"TheOtherCellBelow", "hiz", "ivec2(equal(ivec2(beyond), grid.forward))", "ivec2(beyond)", {}},
        replaced("PixelFromThePosition", "cross_borders",
                 "ivec2 mutated_cross_borders(Grid grid, ivec2 cell, real2 t_border, real t) { return cell; }", {},
                 "dda"),
        {"BorderlineDepthIsAMiss", "dda", "contact       = test_pixel(ray, grid, pixel, t_in, t_out);",
         "contact = test_pixel(ray, grid, pixel, t_in, t_out); contact.found = contact.found && "
         "depth_in(contact.words, pixel) > "
         "min(depth_at(ray, t_in), depth_at(ray, t_out));",
         "equality_counts"},
        replaced("EmptyIntervalsEndTooLate", "empty_interval",
                 "real2 mutated_empty_interval(int number) { real2 t = empty_interval(number); return real2(t.x, t.y + "
                 "real(0.02)); }",
                 {}, "hiz_packets"),
        replaced("EmptyIntervalsBeginTooEarly", "empty_interval",
                 "real2 mutated_empty_interval(int number) { real2 t = empty_interval(number); return real2(t.x < "
                 "real(1) ? real(0) : t.x, t.y); }",
                 {}, "hiz_packets"),
        {"OutOfStepsIsAMiss", "hiz", "out_of_steps(visited)", "miss(ray, visited)", "seven_steps"},
        {"StopsBehindTheFirstObject", "dda", "while (!contact.found && t_out < grid.t_end",
         "while (!contact.found && (visited == 0 || depth_at(ray, t_out) >= depth_in(contact.words, contact.pixel)) && "
         "t_out < "
         "grid.t_end",
         "floating_beam"},
        {"HitBeyondTheEnd", "dda", "if (contact.found) return hit(ray, contact, visited);",
         "if (contact.found) return hit_at(ray, contact, contact.t_in + real(1), visited);", "axis_aligned"},
        replaced("FacesIsAlwaysTrue", "test_pixel",
                 "Contact mutated_test_pixel(Ray ray, Grid grid, ivec2 pixel, real a, real b) { Contact c = "
                 "test_pixel(ray, grid, pixel, a, b); c.found = interval_touches(depth_in(c.words, pixel), "
                 "depth_interval(ray, depth_at(ray, a), depth_at(ray, b))); return c; }",
                 "facing_rule", "dda"),
        replaced("FacingAwayWithoutReason", "miss",
                 "TraceResult mutated_miss(Ray ray, int steps) { return TraceResult(behind_rule != BEHIND_HIT ? "
                 "TRACE_FACING_AWAY : ray.end_status, ivec2(0), real(0), steps); }",
                 "facing_rule", "dda"),
        replaced("NeverFacingAway", "miss",
                 "TraceResult mutated_miss(Ray ray, int steps) { return TraceResult(ray.end_status, ivec2(0), real(0), "
                 "steps); }",
                 "facing_rule", "dda"),
        replaced("AlwaysAMiss", "test_pixel",
                 "Contact mutated_test_pixel(Ray ray, Grid grid, ivec2 pixel, real a, real b) { return no_contact(); }",
                 "axis_aligned", "dda"),
        {"NotANumber", "dda", "return t_out < grid.t_end ? out_of_steps(visited) : miss(ray, visited);",
         "return TraceResult(ray.end_status, ivec2(0), sqrt(ray.delta.z - real(1)), visited);",
         "one_object_in_the_sky"},
    };
}

/// Rays of a small campaign on which the mutant and the pixel walk differ.
size_t campaign_differences(const Technique& mutant)
{
    size_t differ = 0;
    for (const glm::ivec2& size : {glm::ivec2(641, 359), glm::ivec2(4099, 33)})
        for (const Field field : all_fields) {
            const ssrlab::Setup setup   = make_field(field, size, 5);
            const auto          gbuffer = upload_depth(device(), setup.gbuffer.view, setup.gbuffer.depth);
            const auto          rays    = random_rays(size, 50'000, 23);
            const auto          trace   = [&](const Technique& t) {
                // Beyond what any of these rays needs; mutants that never end then end soon.
                const auto tracer =
                    tracer_on(gbuffer, t, values_of(t, {{"max_steps", 10'000}}), campaign_settings, rays.size());
                return trace_rays(device(), *tracer, rays);
            };
            const auto walk = trace(technique("dda")), found = trace(mutant);
            for (size_t i = 0; i < rays.size(); ++i)
                differ += found[i].status != walk[i].status ||
                          (walk[i].status == TraceStatus::hit &&
                           (found[i].hit_pixel != walk[i].hit_pixel || found[i].t != walk[i].t));
        }
    return differ;
}

class Mutations : public testing::TestWithParam<Mutation> {};

TEST_P(Mutations, AreNoticed)
{
    const Mutation& mutation = GetParam();
    const Mutant    mutant(mutation.technique, mutation.from, mutation.to);
    if (mutation.seen_in.empty()) {
        const size_t differ = campaign_differences(*mutant);
        fmt::print("{}: {} of 400000 rays differ\n", mutation.name, differ);
        EXPECT_GT(differ, 0U);
    } else {
        const CaseRow row = run_case(device(), catalogue(), *mutant, default_values(*mutant), "",
                                     find_case(mutation.seen_in), {.double_precision = false});
        fmt::print("{}: {} claims broken in {}\n", mutation.name, row.breaks, mutation.seen_in);
        EXPECT_GT(row.breaks, 0U);
    }
}

INSTANTIATE_TEST_SUITE_P(Each, Mutations, testing::ValuesIn(mutations()),
                         [](const testing::TestParamInfo<Mutation>& mutation) { return mutation.param.name; });

} // namespace
} // namespace ssrlab::test
