// technique.toml: what it says, and what a mistake in it is answered with.
#include "core/error.h"
#include "core/files.h"
#include "errors.h"
#include "temp_folder.h"
#include "test.h"
#include "trace/catalogue.h"

namespace ssrlab {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

/// A directory of techniques that vanishes with the test.
struct TechniqueDir : TempFolder {
    fs::path add(const std::string& id, const std::string& manifest, bool with_trace = true) const
    {
        fs::create_directories(path() / id);
        write_file_atomically(path() / id / "technique.toml", manifest);
        if (with_trace) write_file_atomically(path() / id / "trace.glsl", "TraceResult trace(Ray ray) {}\n");
        return path() / id;
    }
};

const std::string head = "name = \"Walk\"\nsummary = \"Walks.\"\n";

TEST(TechniqueManifest, AccuracyNamesNumbersAndADirection)
{
    const TechniqueDir dir;
    const std::string  tail = "[parameters]\nsteps = { default = 4, min = 1, max = 9, doc = \"d\" }\n"
                              "fine = { default = true, doc = \"d\" }\n";
    const auto         load = [&](const std::string& id, const std::string& line) {
        return load_technique(dir.add(id, head + line + "\n" + tail));
    };
    EXPECT_THAT(load("none", "").accuracy, testing::IsEmpty());
    const auto one = load("one", "accuracy = { parameter = \"steps\", better = \"higher\" }").accuracy;
    ASSERT_EQ(one.size(), 1U);
    EXPECT_EQ(one[0].parameter, "steps");
    EXPECT_TRUE(one[0].higher_is_better);
    EXPECT_FALSE(
        load("list", "accuracy = [{ parameter = \"steps\", better = \"lower\" }]").accuracy.at(0).higher_is_better);
    const std::pair<std::string, std::string> mistakes[] = {
        {"accuracy = { parameter = \"step\", better = \"higher\" }", "technique.toml:3: "},
        {"accuracy = { parameter = \"fine\", better = \"higher\" }",
         ":3: 'accuracy' names 'fine', which is not a number"},
        {"accuracy = { parameter = \"steps\", better = \"more\" }",
         ":3: 'better' must be \"higher\" or \"lower\", got the string \"more\""},
        {"accuracy = { parameter = \"steps\" }", ":3: 'accuracy' has no 'better'"},
        {"accuracy = { parameter = \"steps\", best = \"lower\" }", ":3: unknown field of 'accuracy' 'best'"},
        {"accuracy = \"steps\"", ":3: 'accuracy' must be"}};
    int number = 0;
    for (const auto& mistake : mistakes) {
        const auto loaded = [&] { load("mistake" + std::to_string(number++), mistake.first); };
        EXPECT_THAT(message_of<SpecError>(loaded), HasSubstr(mistake.second)) << mistake.first;
    }
}

TEST(TechniqueManifest, WhatAnOwnHitTestIgnoresIsDeclared)
{
    const TechniqueDir dir;
    EXPECT_THAT(load_technique(dir.add("own", head + "ignores = [\"behind\", \"thickness\"]\n")).ignores,
                ElementsAre("behind", "thickness"));
    EXPECT_THAT(message_of<SpecError>([&] { load_technique(dir.add("vague", head + "ignores = [\"facing\"]\n")); }),
                HasSubstr("vague/technique.toml:3: unknown part of the hit test 'facing'"));
    EXPECT_THAT(message_of<SpecError>(
                    [&] { load_technique(dir.add("both", head + "exact = true\nignores = [\"behind\"]\n")); }),
                HasSubstr("both/technique.toml:4: 'ignores' contradicts 'exact'"));
}

TEST(TechniqueManifest, AnOwnHitTestOfWhichNothingIsSaidIsUnknown)
{
    const TechniqueDir dir;
    const auto         ignores = [&](const std::string& id, const std::string& manifest, const std::string& shader) {
        const fs::path folder = dir.add(id, head + manifest);
        write_file_atomically(folder / "trace.glsl", shader);
        return load_technique(folder).ignores;
    };
    const std::string asks  = "Contact contact = test_pixel(ray, pixel, t_in, t_out);\n",
                      reads = "real z = fetch_depth(pixel);\n";
    EXPECT_THAT(ignores("asks", "", asks), testing::IsEmpty());
    EXPECT_THAT(ignores("samples", "", "Contact contact = test_sample(ray, pixel, t);\n"), testing::IsEmpty());
    EXPECT_THAT(ignores("neither", "", "// its own\n"), ElementsAre("unknown"));
    EXPECT_THAT(ignores("reads", "", asks + reads), ElementsAre("unknown"));
    EXPECT_THAT(ignores("says", "ignores = []\n", asks + reads), testing::IsEmpty());
    EXPECT_THAT(ignores("exact", "exact = true\n", reads), testing::IsEmpty());
    fs::create_directories(dir.path() / "asks" / "parts");
    write_file_atomically(dir.path() / "asks" / "parts" / "own.glsl", reads);
    EXPECT_THAT(load_technique(dir.path() / "asks").ignores, ElementsAre("unknown"));
}

TEST(TechniqueManifest, LimitsAreKnownNamesAndBelongToInexactTechniques)
{
    const TechniqueDir dir;
    EXPECT_THAT(load_technique(dir.add("march", head + "limits = [\"point_sampled\"]\n")).limits,
                ElementsAre("point_sampled"));
    EXPECT_THAT(
        message_of<SpecError>([&] { load_technique(dir.add("vague", head + "limits = [\"point_sampel\"]\n")); }),
        HasSubstr("vague/technique.toml:3: unknown limit 'point_sampel': did you mean 'point_sampled'?"));
    EXPECT_THAT(message_of<SpecError>(
                    [&] { load_technique(dir.add("both", head + "exact = true\nlimits = [\"point_sampled\"]\n")); }),
                HasSubstr("both/technique.toml:4: 'limits' contradicts 'exact'"));
}

TEST(TechniqueManifest, ReadsEveryField)
{
    const TechniqueDir dir;
    Structure          pyramid;
    pyramid.id                = "depth_pyramid";
    pyramid.parameters        = {{"depth_pyramid.top_level", ParameterType::integer, 7, 0, 14, {}, "Coarsest level."}};
    const Structure known[]   = {pyramid};
    const Technique technique = load_technique(dir.add("walk", R"(name    = "Walk"
summary = "Walks the pyramid."
cite    = ["A 2014", "B 2020"]
structures = ["depth_pyramid"]
exact   = true
bounded_by = ["steps", "binary_steps"]
[parameters]
steps        = { default = 64, min = 1, max = 50000, doc = "Steps." }
stride_px    = { default = 1.5, min = 0, max = inf, doc = "Stride." }
jitter       = { default = false, doc = "Jitter." }
space        = { default = "screen", choices = ["view", "screen"], defines = { view = "IN_VIEW" }, doc = "Space." }
binary_steps = { default = 0, min = 0, max = 32, doc = "Bisections." }
)"),
                                               known);
    EXPECT_EQ(technique.id, "walk");
    EXPECT_THAT(technique.cite, ElementsAre("A 2014", "B 2020"));
    EXPECT_TRUE(technique.exact);
    EXPECT_THAT(technique.limits, ElementsAre());
    ASSERT_EQ(technique.parameters.size(), 6U);
    EXPECT_EQ(technique.parameters[5].name, "depth_pyramid.top_level"); // its structures' come last
    EXPECT_EQ(technique.structures.at(0).id, "depth_pyramid");
    EXPECT_EQ(technique.parameters[0].name, "steps"); // as declared, not sorted
    EXPECT_EQ(technique.parameters[0].type, ParameterType::integer);
    EXPECT_EQ(technique.parameters[1].type, ParameterType::real);
    EXPECT_EQ(technique.parameters[1].max, std::numeric_limits<double>::infinity());
    EXPECT_EQ(technique.parameters[2].type, ParameterType::boolean);
    EXPECT_EQ(technique.parameters[3].type, ParameterType::choice);
    EXPECT_EQ(technique.parameters[3].default_value, 1);
    EXPECT_EQ(iteration_bound(technique, {{"steps", 100}, {"binary_steps", 10}}), 110);
    EXPECT_EQ(default_values(technique).at("stride_px"), 1.5);
    ParameterValues values = default_values(technique);
    EXPECT_THAT(shader_macros(technique, values), ElementsAre());
    values.at("space") = 0;
    EXPECT_THAT(shader_macros(technique, values), ElementsAre("IN_VIEW"));
}

TEST(TechniqueManifest, MistakesAreNamedWithFileAndLine)
{
    struct Mistake {
        const char* line; // line 4, inside [parameters]
        const char* message;
    };
    const Mistake mistakes[] = {
        {"steps = { default = 0, min = 1, max = 60000, doc = \"d\" }",
         ":4: default 0 of 'steps' is outside [1, 60000]"},
        {"steps = { default = 1, min = 9, max = 2, doc = \"d\" }", ":4: min 9 of 'steps' is above its max 2"},
        {"steps = { default = 1, min = 1, max = 2 }", ":4: parameter 'steps' has no 'doc'"},
        {"steps = { default = 1, min = 1, doc = \"d\" }", ":4: parameter 'steps' has no 'max'"},
        {"steps = { default = 1, min = 0.5, max = 2, doc = \"d\" }",
         ":4: 'min of steps' must be an integer, got the number 0.5"},
        {"steps = { default = nan, min = 0, max = 2, doc = \"d\" }",
         ":4: 'default of steps' must be a number, got nan, which is not a number"},
        {"steps = { default = 1.0, min = nan, max = 2, doc = \"d\" }", ":4: 'min of steps' must be a number"},
        {"steps = { default = [1], min = 1, max = 2, doc = \"d\" }", ":4: 'default of steps' must be"},
        {"steps = { defualt = 1, min = 1, max = 2, doc = \"d\" }",
         ":4: unknown field of parameter 'steps' 'defualt': did you mean 'default'?"},
        {"steps = 7", ":4: 'steps' must be a table, got the integer 7"},
        {"mode = { default = \"c\", choices = [\"a\", \"b\"], doc = \"d\" }",
         ":4: 'mode' must be one of a, b, got 'c'"},
        {"mode = { default = \"a\", choices = [], doc = \"d\" }", ":4: 'mode' must be one of"},
        {"mode = { default = \"a\", choices = [\"a\", \"a\"], doc = \"d\" }",
         ":4: 'choices' of 'mode' names one twice"},
        {"mode = { default = true, min = 0, doc = \"d\" }", ":4: 'min' belongs to numbers"},
        {"mode = { default = \"a\", choices = [\"a\", \"b\"], defines = { c = \"C\" }, doc = \"d\" }",
         ":4: unknown choice of 'mode' 'c'"},
        {"mode = { default = true, defines = { a = \"A\" }, doc = \"d\" }", ":4: 'defines' belongs to choices"},
        {"\"two words\" = { default = true, doc = \"d\" }",
         ":4: parameter 'two words' is not a name that GLSL accepts: expected letters, digits"},
        {"float = { default = true, doc = \"d\" }", ":4: parameter 'float' is not a name that GLSL accepts"},
        {"ray = { default = true, doc = \"d\" }",
         ":4: parameter 'ray' is not a name that GLSL accepts: it is a name of the shader functions"},
        {"steps = { default = 1, min = 1, max = 2, doc = \"d\" ", ":4: "},
    };
    const TechniqueDir dir;
    for (const Mistake& mistake : mistakes) {
        const fs::path folder = dir.add("walk", head + "[parameters]\n" + mistake.line + "\n");
        EXPECT_THAT(message_of<SpecError>([&] { load_technique(folder); }),
                    HasSubstr("walk/technique.toml" + std::string(mistake.message)))
            << mistake.line;
    }
}

TEST(TechniqueManifest, MistakesAboveTheParameters)
{
    const TechniqueDir dir;
    const auto         message = [&](const std::string& manifest) {
        return message_of<SpecError>([&] { load_technique(dir.add("walk", manifest)); });
    };
    EXPECT_THAT(message("summary = \"Walks.\"\n"), HasSubstr("the technique has no 'name'"));
    EXPECT_THAT(message("name = 7\nsummary = \"Walks.\"\n"),
                HasSubstr(":1: 'name' must be a non-empty string, got the integer 7"));
    EXPECT_THAT(message(head + "structures = \"depth\"\n"), HasSubstr(":3: 'structures' must be a list of strings"));
    EXPECT_THAT(message(head + "structures = [\"depth_pyramyd\"]\n"),
                HasSubstr(":3: unknown structure 'depth_pyramyd'"));
    EXPECT_THAT(message(head + "rays_per_invocation = 3\n"), HasSubstr(":3: 'rays_per_invocation' must be 1 or 2"));
    EXPECT_THAT(message(head + "exact = 1\n"), HasSubstr(":3: 'exact' must be true or false"));
    EXPECT_THAT(message(head + "exakt = true\n"), HasSubstr(":3: unknown key 'exakt': did you mean 'exact'?"));
    EXPECT_THAT(message(head + "bounded_by = [\"steps\"]\n"),
                HasSubstr(":3: unknown parameter of technique walk 'steps'"));
}

TEST(TechniqueManifest, ATechniqueNeedsItsTraceFunction)
{
    const TechniqueDir dir;
    const fs::path     folder = dir.add("walk", head, false);
    EXPECT_THAT(message_of<SpecError>([&] { load_technique(folder); }), HasSubstr("walk/trace.glsl: missing"));
    EXPECT_THAT(message_of<SpecError>([&] { load_technique(dir.path() / "absent"); }),
                HasSubstr("technique.toml: no such file"));
    EXPECT_THAT(message_of<SpecError>([&] { load_technique(dir.add("two words", head)); }),
                HasSubstr("technique's id"));
}

TEST(TechniqueManifest, DirectoriesAreSearchedAndDuplicatesRefused)
{
    const TechniqueDir first, second;
    first.add("test_walk_a", head);
    first.add("test_walk_b", head);
    second.add("test_walk_b", head);
    const fs::path only_first[] = {first.path()};
    const fs::path twice[]      = {first.path(), first.path() / "test_walk_a"}; // the same folder again is no conflict
    const fs::path conflict[]   = {first.path(), second.path()};
    const fs::path absent[]     = {first.path() / "absent"};
    EXPECT_EQ(find_technique(load_catalogue(only_first).techniques, "test_walk_a").summary, "Walks.");
    EXPECT_EQ(load_catalogue(twice).techniques.size(), load_catalogue(only_first).techniques.size());
    EXPECT_THAT(message_of<SpecError>([&] { load_catalogue(conflict); }),
                HasSubstr("two techniques are called 'test_walk_b'"));
    EXPECT_THAT(message_of<SpecError>([&] { load_catalogue(absent); }), HasSubstr("no such directory"));
    EXPECT_THAT(message_of<SpecError>([&] { find_technique(load_catalogue(only_first).techniques, "test_wolk_a"); }),
                HasSubstr("did you mean 'test_walk_a'?"));
}

TEST(TechniqueManifest, ValuesAreParsedCheckedAndPrinted)
{
    const Parameter steps{"steps", ParameterType::integer, 64, 1, 100, {}, "d"};
    const Parameter stride{"stride", ParameterType::real, 1, 0, 10, {}, "d"};
    const Parameter jitter{"jitter", ParameterType::boolean, 0, 0, 1, {}, "d"};
    const Parameter space{"space", ParameterType::choice, 0, 0, 1, {"view", "screen"}, "d"};
    for (const auto& [parameter, text] : std::vector<std::pair<Parameter, std::string>>{
             {steps, "10"}, {stride, "0.5"}, {jitter, "true"}, {space, "screen"}}) {
        EXPECT_EQ(format_parameter(parameter, parse_parameter(parameter, text, "-p")), text);
    }
    for (const char* text : {"", "ten", "1.5", "0", "101", "nan", "inf", "1e400", "7 ", "0x10"}) {
        EXPECT_THAT(message_of<SpecError>([&] { parse_parameter(steps, text, "-p"); }),
                    HasSubstr("-p: 'steps' must be an integer in [1, 100], got"))
            << text;
    }
    EXPECT_THAT(message_of<SpecError>([&] { parse_parameter(stride, "nan", "-p"); }),
                HasSubstr("must be a number in [0, 10]"));
    EXPECT_THAT(message_of<SpecError>([&] { parse_parameter(jitter, "1", "-p"); }),
                HasSubstr("must be true or false, got '1'"));
    EXPECT_THAT(message_of<SpecError>([&] { parse_parameter(space, "clip", "-p"); }),
                HasSubstr("must be one of view, screen"));
    EXPECT_THAT(message_of<SpecError>([&] { check_parameter(steps, std::numeric_limits<double>::quiet_NaN(), "-p"); }),
                HasSubstr("got nan"));
}

} // namespace
} // namespace ssrlab
