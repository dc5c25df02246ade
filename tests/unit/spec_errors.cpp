// An experiment file: each mistake is answered with file, line, expected and got.
#include "core/error.h"
#include "core/files.h"
#include "harness/experiment.h"
#include "test.h"

namespace ssrlab {
namespace {

using testing::HasSubstr;

Technique made_technique(const char* id, std::vector<std::string> bounded_by, std::vector<Parameter> parameters)
{
    Technique technique;
    technique.id = technique.name = id;
    technique.bounded_by          = std::move(bounded_by);
    technique.parameters          = std::move(parameters);
    return technique;
}

const std::vector<Technique>& techniques()
{
    using enum ParameterType;
    static const std::vector<Technique> both = {
        made_technique("linear", {"steps", "binary_steps"},
                       {{"steps", integer, 64, 1, 60000, {}, "d"},
                        {"binary_steps", integer, 0, 0, 60000, {}, "d"},
                        {"space", choice, 0, 0, 1, {"view", "screen"}, "d"},
                        {"jitter", boolean, 0, 0, 1, {}, "d"},
                        {"stride", real, 1, 0.5, 8, {}, "d"}}),
        made_technique("dda", {"max_steps"}, {{"max_steps", integer, 60000, 1, 60000, {}, "d"}})};
    return both;
}

const Catalogue& catalogue()
{
    static const Catalogue known = [] {
        Catalogue found  = load_catalogue();
        found.techniques = techniques();
        return found;
    }();
    return known;
}

Experiment load_text(const std::string& text)
{
    const auto path = std::filesystem::temp_directory_path() / fmt::format("spec_{}.toml", ::getpid());
    write_file_atomically(path, text);
    Experiment experiment = load_experiment(path, catalogue());
    std::filesystem::remove(path);
    return experiment;
}

std::string error_of(const std::string& text)
{
    try {
        expand(load_text(text), techniques());
    } catch (const SpecError& error) {
        return error.what();
    }
    return "(no SpecError)";
}

// Line 1 and 2 are right, line 3 is the mistake.
std::string with_line(const std::string& line)
{
    return "scenes = [\"builtin:stairs\"]\ntechniques.dda = {}\n" + line + "\n";
}

TEST(Spec, MistakesAtTheTop)
{
    EXPECT_THAT(error_of(with_line("nome = \"x\"")), HasSubstr(".toml:3: unknown key 'nome': did you mean 'name'?"));
    EXPECT_THAT(error_of(with_line("name = 7")),
                HasSubstr(".toml:3: 'name' must be a non-empty string, got the integer 7"));
    EXPECT_THAT(error_of(with_line("name = \"../x\"")), HasSubstr(".toml:3: 'name' must be letters"));
    EXPECT_THAT(error_of(with_line("title = \"\"")), HasSubstr(".toml:3: 'title' must be a non-empty string"));
    EXPECT_THAT(error_of(with_line("views = []")), HasSubstr(".toml:3: 'views' is an empty list"));
    EXPECT_THAT(error_of(with_line("views = [1]")),
                HasSubstr(".toml:3: 'views' must be a non-empty string, got the integer 1"));
    EXPECT_THAT(error_of(with_line("name = \"a\"\nname = \"b\"")), HasSubstr(".toml:4: "));
    EXPECT_THAT(error_of(with_line("name = ")), HasSubstr(".toml:3: "));
    EXPECT_THAT(error_of("scenes = []\ntechniques.dda = {}\n"), HasSubstr(".toml:1: 'scenes' is an empty list"));
    EXPECT_THAT(error_of("techniques.dda = {}\n"), HasSubstr("names no scene"));
    EXPECT_THAT(error_of("scenes = [\"a\"]\n"), HasSubstr("names no technique"));
    EXPECT_THROW(load_experiment("/nonexistent/a.toml", catalogue()), SpecError);
    EXPECT_THROW(load_experiment("/dev/zero", catalogue()), Failure); // which never ends
}

TEST(Spec, Sizes)
{
    for (const char* size : {"\"0x720\"", "\"1280x0\"", "\"16385x1\"", "\"-1x5\""}) {
        EXPECT_THAT(error_of(with_line(fmt::format("sizes = [\"8x8\", {}]", size))),
                    HasSubstr(".toml:3: 'sizes' must be from 1x1"));
    }
    for (const char* size : {"\"1280\"", "\"x\"", "\"1280x720p\"", "\"1280 x 720\"", "\"99999999999x1\""}) {
        EXPECT_THAT(error_of(with_line(fmt::format("sizes = {}", size))),
                    HasSubstr(".toml:3: 'sizes' must be a size like"));
    }
    EXPECT_THAT(error_of(with_line("sizes = 720")),
                HasSubstr(".toml:3: 'sizes' must be a non-empty string, got the integer 720"));
}

TEST(Spec, EverySettingAgainstEveryMistake)
{
    for (const Setting& setting : all_settings(catalogue())) {
        const auto mistake = [&](const std::string& value) {
            return error_of(with_line(fmt::format("[{}]\n{} = {}", setting.table, setting.name, value)));
        };
        const std::string place = fmt::format(".toml:4: '{}' ", setting.name);
        EXPECT_THAT(mistake("\"x\""), HasSubstr(place + "must be"));
        EXPECT_THAT(mistake("[]"), HasSubstr(place + "is an empty list"));
        EXPECT_THAT(mistake("{}"), HasSubstr(place + "must be"));
        EXPECT_THAT(mistake("nan"), HasSubstr(place + "must be"));
        EXPECT_THAT(mistake("-2"), HasSubstr(place + "must be"));
        EXPECT_THAT(mistake("[true, 7]"), HasSubstr(place + "must be"));
    }
    EXPECT_THAT(error_of(with_line("[trace]\nthicknes_m = 1")),
                HasSubstr(".toml:4: unknown setting of [trace] 'thicknes_m': did you mean 'thickness_m'?"));
    EXPECT_THAT(error_of(with_line("trace = 7")), HasSubstr(".toml:3: 'trace' must be a table"));
    EXPECT_EQ(error_of(with_line("[trace]\nmax_distance_m = [9, inf]")), "(no SpecError)");
}

TEST(Spec, EveryParameterAgainstEveryMistake)
{
    const auto mistake = [](const std::string& line) {
        return error_of("scenes = \"a\"\n[techniques.linear]\n" + line + "\n");
    };
    EXPECT_THAT(mistake("stebs = 7"),
                HasSubstr(".toml:3: unknown parameter of technique linear 'stebs': did you mean 'steps'?"));
    EXPECT_THAT(mistake("steps = [25, 0]"), HasSubstr(".toml:3: 'steps' must be an integer in [1, 60000], got 0"));
    EXPECT_THAT(mistake("steps = 60001"), HasSubstr("got 60001"));
    EXPECT_THAT(mistake("steps = 25.0"), HasSubstr(".toml:3: 'steps' must be an integer, got the number 25"));
    EXPECT_THAT(mistake("steps = nan"), HasSubstr(".toml:3: 'steps' must be an integer, got nan, which is not a number"));
    EXPECT_THAT(mistake("steps = [\n25,\n\"x\"]"),
                HasSubstr(".toml:5: 'steps' must be an integer, got the string \"x\""));
    EXPECT_THAT(mistake("steps = []"), HasSubstr(".toml:3: 'steps' is an empty list"));
    EXPECT_THAT(mistake("steps = 9223372036854775807"), HasSubstr(".toml:3: 'steps' must be"));
    EXPECT_THAT(mistake("stride = 0.1"), HasSubstr(".toml:3: 'stride' must be a number in [0.5, 8], got 0.1"));
    EXPECT_THAT(mistake("stride = nan"), HasSubstr(".toml:3: 'stride' must be a number, got nan, which is not a number"));
    EXPECT_THAT(mistake("stride = 1e308"), HasSubstr(".toml:3: 'stride' must be a number in [0.5, 8]"));
    EXPECT_THAT(mistake("space = \"veiw\""), HasSubstr(".toml:3: 'space' must be one of view, screen, got 'veiw'"));
    EXPECT_THAT(mistake("space = 1"), HasSubstr(".toml:3: 'space' must be a non-empty string"));
    EXPECT_THAT(mistake("jitter = 1"), HasSubstr(".toml:3: 'jitter' must be true or false, got the integer 1"));
    EXPECT_THAT(mistake("steps = 60000\nbinary_steps = 1"),
                HasSubstr(".toml:2: linear with these values may need 60001 iterations"));
    EXPECT_THAT(error_of("scenes = \"a\"\n[techniques.lineer]\n"),
                HasSubstr(".toml:2: unknown technique 'lineer': did you mean 'linear'?"));
    EXPECT_THAT(error_of("scenes = \"a\"\ntechniques.linear = 7\n"),
                HasSubstr(".toml:2: 'techniques.linear' must be a table"));
}

TEST(Spec, TargetsAgainstEveryMistake)
{
    const std::pair<std::string, std::string> mistakes[] = {
        {"[targets]\nrecall = 0.9", "unknown measure of [targets] 'recall'"},
        {"[targets]\nrecall_1px = 1.5", "'recall_1px' must be in [0, 1], got the number 1.5"},
        {"[targets]\nf1_1px = []", "'f1_1px' is an empty list"},
        {"[targets]\nf1_1px = \"0.9\"", "'f1_1px' must be"},
        {"[measure]\ntruth = false\n[targets]\nf1_1px = 0.9", "needs truth = true in [measure], got false"},
        {"[measure]\nimage_errors = false\n[targets]\nflip_visible = 0.1", "needs image_errors = true"}};
    for (const auto& [lines, answer] : mistakes) EXPECT_THAT(error_of(with_line(lines)), HasSubstr(answer)) << lines;
}

TEST(Spec, EveryMeasureFieldAgainstEveryMistake)
{
    for (const char* field : {"seed", "warmup_s", "min_repeats", "max_repeats", "budget_s", "frames_per_submit",
                              "truth", "image_errors", "double_twin", "pictures", "saved_time"}) {
        for (const char* value : {"\"x\"", "[]", "nan", "-1", "{}"}) {
            EXPECT_THAT(error_of(with_line(fmt::format("[measure]\n{} = {}", field, value))),
                        HasSubstr(fmt::format(".toml:4: '{}' must be", field)))
                << value;
        }
    }
    EXPECT_THAT(error_of(with_line("[measure]\nmin_repeats = 9\nmax_repeats = 8")),
                HasSubstr(".toml:3: max_repeats 8 is below min_repeats 9"));
    EXPECT_THAT(error_of(with_line("[measure]\nbudget = 9")),
                HasSubstr(".toml:4: unknown key of [measure] 'budget': did you mean 'budget_s'?"));
}

TEST(Spec, AListIsASweep)
{
    const Experiment experiment = load_text(R"(
name   = "sweep"
scenes = ["a", "b"]
views  = ["left", "right"]
sizes  = ["640x360", "641x363", "1x1"]
[trace]
thickness_m = [0.1, 0.2]
[[techniques.linear]]
steps = [25, 50, 100]
space = ["view", "screen"]
[[techniques.linear]]
binary_steps = 10
[techniques.dda]
)");
    const auto       runs       = expand(experiment, techniques());
    EXPECT_EQ(runs.size(), 2U * 2 * 3 * 2 * (3 * 2 + 1 + 1));
    EXPECT_EQ(count_runs(experiment), static_cast<double>(runs.size()));
    EXPECT_EQ(runs.front().settings.trace.thickness_m, 0.1);
    EXPECT_EQ(runs.front().values.at("steps"), 25);
    EXPECT_EQ(runs.front().values.at("stride"), 1); // default
    EXPECT_EQ(runs.back().technique, "dda");
    int pictures = 1; // one picture's runs stand together
    for (size_t i = 1; i < runs.size(); ++i) {
        const bool same = runs[i].scene == runs[i - 1].scene && runs[i].view == runs[i - 1].view &&
                          runs[i].size_px == runs[i - 1].size_px;
        pictures += same ? 0 : 1;
    }
    EXPECT_EQ(pictures, 2 * 2 * 3);
}

TEST(Spec, AListOfViewsMayBeOfOneScene)
{
    const std::string        head       = "scenes = [\"a\", \"b:c\"]\n[techniques.dda]\n";
    const Experiment         experiment = load_text("views = { \"b:c\" = [\"left\", \"default\"] }\n" + head);
    std::vector<std::string> frames;
    for (const ssrlab::Run& run : expand(experiment, techniques())) frames.push_back(run.scene + " " + run.view);
    EXPECT_THAT(frames, testing::ElementsAre("a default", "b:c left", "b:c default"));
    EXPECT_EQ(count_runs(experiment), 3);
    EXPECT_THAT(error_of("views = { c = \"left\" }\n" + head), HasSubstr(".toml:1: unknown scene of 'views' 'c'"));
    EXPECT_THAT(error_of("views = { a = [] }\n" + head), HasSubstr(".toml:1: 'a' is an empty list"));
}

TEST(Spec, ATechniquesTableMayNameSettingsOfItsOwn)
{
    const Experiment experiment =
        load_text("scenes = \"a\"\n[trace]\nthickness_m = [0.1, "
                  "0.2]\n[[techniques.linear]]\n[[techniques.linear]]\nthickness_m = 0.5\nedge_fade = \"border\"\n");
    const auto runs = expand(experiment, techniques());
    ASSERT_EQ(runs.size(), 3U);
    EXPECT_EQ(count_runs(experiment), 3);
    const auto edge_fade = [](const auto& run) { return choice<EdgeFade>(run.settings.passes); };
    EXPECT_EQ(std::ranges::count(runs, EdgeFade::border, edge_fade), 1);
    EXPECT_EQ(std::ranges::count(runs, EdgeFade::off, edge_fade), 2);
    EXPECT_THAT(error_of("scenes = \"a\"\n[techniques.linear]\nthickness_m = -1\n"),
                HasSubstr(".toml:3: 'thickness_m' must be a number in [0, "));
}

TEST(Spec, EveryListOfSourcesIsARun)
{
    const std::string head     = "scenes = \"a\"\n[techniques.linear]\nsteps = [32, 64]\n";
    const auto        asked_by = [&](const std::string& table) {
        const Experiment         experiment = load_text(head + table);
        std::vector<std::string> asked;
        for (const ssrlab::Run& run : expand(experiment, techniques()))
            asked.push_back(fmt::format("{} {} {}", run.values.at("steps"), run.sources.text,
                                               hand_on_names[static_cast<size_t>(run.sources.hand_on)]));
        EXPECT_EQ(count_runs(experiment), asked.size());
        return asked;
    };
    EXPECT_THAT(asked_by("[sources]\nlists = [\"world\", \"frame,layers:count=2\"]\nhand_on = \"lost\"\n"),
                testing::ElementsAre("32 world lost", "32 frame,layers:count=2 lost", "64 world lost",
                                     "64 frame,layers:count=2 lost"));
    EXPECT_THAT(asked_by("[[sources]]\nlists = \"world\"\n[[sources]]\nlists = \"frame\"\nhand_on = [\"lost\", "
                         "\"uncertain\"]\n"),
                testing::ElementsAre("32 world uncertain", "32 frame lost", "32 frame uncertain", "64 world uncertain",
                                     "64 frame lost", "64 frame uncertain"));
    const auto list = load_text(head + "[sources]\nlists = \"frame,layers:count=2\"\n").sources.front().list;
    ASSERT_EQ(list.size(), 2U);
    EXPECT_EQ(list[0].source->id, "frame");
    EXPECT_EQ(list[1].source->id, "layers");
    EXPECT_EQ(list[1].values.at("count"), 2);
    EXPECT_TRUE(load_text(head).sources.front().list.empty()) << "none without the table";
}

TEST(Spec, ATechniquesOwnSourcesStandInPlaceOfTheExperiments)
{
    const Experiment experiment =
        load_text("scenes = \"a\"\n[techniques.linear]\nsources = [\"frame\", \"frame,cube\"]\n"
                  "[techniques.dda]\n[sources]\nlists = \"world\"\n");
    std::vector<std::string> asked;
    for (const auto& run : expand(experiment, techniques())) asked.push_back(run.technique + " " + run.sources.text);
    EXPECT_THAT(asked, testing::UnorderedElementsAre("linear frame", "linear frame,cube", "dda world"));
    EXPECT_EQ(count_runs(experiment), 3);
    EXPECT_THAT(error_of("scenes = \"a\"\n[techniques.dda]\nsources = \"wurld\"\n"),
                HasSubstr(".toml:3: 'wurld': unknown source 'wurld': did you mean 'world'?"));
    EXPECT_THAT(error_of("scenes = \"a\"\n[techniques.dda]\nsources = \"frame\"\n[measure]\ntruth = false\n"),
                HasSubstr(".toml:3: sources are judged by the truths"));
}

TEST(Spec, MistakesInSources)
{
    const auto mistake = [](const std::string& lines) { return error_of(with_line("[sources]\n" + lines)); };
    EXPECT_THAT(mistake("lists = [\"frame\", \"frame,wurld\"]"),
                HasSubstr(".toml:4: 'frame,wurld': unknown source 'wurld': did you mean 'world'?"));
    EXPECT_THAT(mistake("lists = \"layers:count=9\""), HasSubstr(".toml:4: 'layers:count=9': "));
    EXPECT_THAT(mistake("lists = \"layers:colour=9\""), HasSubstr("unknown parameter of source 'layers'"));
    EXPECT_THAT(mistake("lists = []"), HasSubstr(".toml:4: 'lists' is an empty list"));
    EXPECT_THAT(mistake("lists = 7"), HasSubstr(".toml:4: 'lists' must be a non-empty string, got the integer 7"));
    EXPECT_THAT(mistake("hand_on = \"lost\""), HasSubstr(".toml:3: [sources] names no list: add lists = "));
    EXPECT_THAT(mistake("lists = \"frame\"\nhand_on = \"some\""),
                HasSubstr(".toml:5: 'hand_on' must be \"lost\" or \"uncertain\", got the string \"some\""));
    EXPECT_THAT(mistake("list = \"frame\""),
                HasSubstr(".toml:4: unknown key of [sources] 'list': did you mean 'lists'?"));
    EXPECT_THAT(mistake("lists = \"frame\"\n[measure]\ntruth = false"),
                HasSubstr(".toml:4: sources are judged by the truths: needs truth = true in [measure], got false"));
    EXPECT_THAT(error_of(with_line("sources = \"frame\"")), HasSubstr(".toml:3: 'sources' must be a table"));
}

TEST(Spec, AFrameOfASequenceIsPartOfARunsIdentity)
{
    const auto ids_of = [](const std::string& lines) {
        std::vector<std::string> ids;
        for (const auto& run : expand(load_text("scenes = \"a\"\n" + lines + "[techniques.dda]\n"), techniques()))
            ids.push_back(run.id);
        return ids;
    };
    const auto still = ids_of(""), three = ids_of("frames = 3\n"), jittered = ids_of("jitter_phases = 16\n");
    ASSERT_EQ(three.size(), 3U);
    EXPECT_EQ(still, std::vector{three[0]}) << "frame 0 is the still frame";
    EXPECT_EQ(ids_of("frames = [2, 0]\n"), (std::vector{three[2], three[0]}));
    EXPECT_NE(three[1], three[2]);
    EXPECT_NE(jittered, still);
    EXPECT_EQ(count_runs(load_text("scenes = \"a\"\nframes = 3\n[techniques.dda]\n")), 3);
    EXPECT_THAT(error_of("scenes = \"a\"\nframes = 0\n[techniques.dda]\n"),
                HasSubstr(".toml:2: 'frames' must be in [1, "));
}

TEST(Spec, IdsAreStableAndARunListedTwiceComesOnce)
{
    const Experiment experiment = load_text("scenes = [\"a\", \"a\"]\nsizes = \"8x8\"\n[trace]\nsurface = \"box\"\n"
                                            "behind = \"hit\"\n[[techniques.linear]]\nsteps = [64, 32, 64]\n"
                                            "[[techniques.linear]]\n");
    const auto       runs       = expand(experiment, techniques());
    ASSERT_EQ(runs.size(), 2U);
    EXPECT_NE(runs[0].id, runs[1].id);
    // Changing how ids are made would orphan every recorded result.
    EXPECT_EQ(runs[0].id, "r4091041f5a5670fb");
}

TEST(Spec, HugeSweepsAskFirst)
{
    std::string list;
    for (int i = 1; i <= 320; ++i) list += std::to_string(i) + ",";
    const std::string text =
        "scenes = \"a\"\n[techniques.linear]\nsteps = [" + list + "]\nbinary_steps = [" + list + "]\n";
    EXPECT_THAT(error_of(text),
                HasSubstr("expands to 102400 runs, more than 100000; shorten a list, or confirm with --yes"));
    EXPECT_EQ(expand(load_text(text), techniques(), true).size(), 102400U);
}

} // namespace
} // namespace ssrlab
