// Manifests of structures: every field, and mistakes named with file and line.
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

struct StructureDir : TempFolder {
    fs::path add(const std::string& id, const std::string& manifest) const
    {
        fs::create_directories(path() / id);
        write_file_atomically(path() / id / "structure.toml", manifest);
        write_file_atomically(path() / id / "build.comp", "void main() {}\n");
        return path() / id;
    }
};

const std::string head   = "name = \"Tiles\"\nsummary = \"Nearest depths.\"\n";
const std::string buffer = "[buffers]\nfronts = { per = \"tile\", tile_px = 8, type = \"float\" }\n";
const std::string pass   = "[[passes]]\nshader = \"build.comp\"\nper = \"tile\"\ntile_px = 8\n";

TEST(StructureManifest, ReadsEveryField)
{
    const StructureDir dir;
    const Structure    structure = load_structure(dir.add("tiles", head + R"(cite = ["A 2014"]
reads = ["depth_pyramid"]
[parameters]
levels = { default = 3, min = 1, max = 9, doc = "Levels." }
[buffers]
fronts = { per = "tile", tile_px = 8, type = "float" }
bounds = { per = "ray_group", type = "real2", count = 4 }
cells  = { per = "depth_cell" }
[[passes]]
shader = "build.comp"
style = "serial"
per = "level"
first_level = 2
last_level = "levels"
cells_per_invocation = [2, 1]
[[passes]]
shader = "build.comp"
style = "parallel"
per = "level"
levels_per_dispatch = 5
[[passes]]
shader = "build.comp"
per = "ray_group"
)"));
    EXPECT_EQ(structure.id, "tiles");
    EXPECT_THAT(structure.reads, ElementsAre("depth_pyramid"));
    ASSERT_EQ(structure.parameters.size(), 1U);
    EXPECT_EQ(structure.parameters[0].name, "tiles.levels");
    ASSERT_EQ(structure.buffers.size(), 3U);
    EXPECT_EQ(structure.buffers[0].tile_px, 8);
    EXPECT_EQ(structure.buffers[1].name, "bounds"); // as declared
    EXPECT_EQ(structure.buffers[1].count, 4);
    EXPECT_EQ(structure.buffers[2].per, SizeRule::depth_cell);
    ASSERT_EQ(structure.passes.size(), 3U);
    EXPECT_EQ(structure.passes[0].style, PassStyle::serial);
    EXPECT_EQ(structure.passes[0].levels_per_dispatch, 1);
    EXPECT_EQ(structure.passes[0].first_level, 2);
    EXPECT_EQ(std::get<std::string>(structure.passes[0].last_level), "tiles.levels");
    EXPECT_EQ(structure.passes[0].cells_per_invocation, glm::ivec2(2, 1));
    EXPECT_EQ(structure.passes[1].style, PassStyle::parallel);
    EXPECT_EQ(structure.passes[1].levels_per_dispatch, 5);
    EXPECT_EQ(structure.passes[2].per, SizeRule::ray_group);
    EXPECT_EQ(structure.passes[2].style, PassStyle::by_device);
}

TEST(StructureManifest, MistakesAreNamedWithFileAndLine)
{
    struct Mistake {
        std::string manifest;
        const char* message;
    };
    const Mistake mistakes[] = {
        {"summary = \"S.\"\n" + buffer + pass, "the structure has no 'name'"},
        {head + pass, "the structure has no 'buffers'"},
        {head + buffer, "the structure has no 'passes'"},
        {head + "reeds = []\n" + buffer + pass, ":3: unknown key 'reeds': did you mean 'reads'?"},
        {head + "[buffers]\nfronts = { per = \"tiel\", type = \"float\" }\n" + pass,
         ":4: unknown size rule 'tiel': did you mean 'tile'? (known: "},
        {head + "[buffers]\nfronts = { per = \"tile\", type = \"float\" }\n" + pass,
         ":4: buffer 'fronts' has no 'tile_px'"},
        {head + "[buffers]\nfronts = { per = \"pixel\", tile_px = 8, type = \"float\" }\n" + pass,
         ":4: 'tile_px' belongs to per = \"tile\""},
        {head + "[buffers]\nfronts = { per = \"pixel\", type = \"mat4\" }\n" + pass, ":4: unknown element type 'mat4'"},
        {head + "[buffers]\nfronts = { per = \"pixel\", type = \"real2\" }\n" + pass, ":4: 'real2' belongs to"},
        {head + "[buffers]\nfronts = { per = \"pixel\" }\n" + pass, ":4: buffer 'fronts' has no 'type'"},
        {head + "[buffers]\nfronts = { per = \"depth_cell\", type = \"uint\" }\n" + pass,
         ":4: 'type' is fixed for per = \"depth_cell\""},
        {head + "[buffers]\nfloat = { per = \"pixel\", type = \"uint\" }\n" + pass,
         ":4: buffer 'float' is not a name that GLSL accepts: it is a word of GLSL"},
        {head + buffer + "[[passes]]\nshader = \"gone.comp\"\nper = \"pixel\"\n", "gone.comp' is not there"},
        {head + buffer + "[[passes]]\nshader = \"build.comp\"\nper = \"pixel\"\nlast_level = 3\n",
         ":8: 'last_level' belongs to per = \"level\""},
        {head + buffer + "[[passes]]\nshader = \"build.comp\"\nper = \"level\"\nlast_level = \"levels\"\n",
         ":8: 'last_level' names 'levels', which is no integer parameter of tiles"},
        {head + buffer + "[[passes]]\nshader = \"build.comp\"\nper = \"level\"\nfirst_level = 0\n",
         ":8: 'first_level of a pass of tiles' must be an integer in [1, 31]"},
        {head + buffer + "[[passes]]\nshader = \"build.comp\"\nper = \"pixel\"\nlevels_per_dispatch = 2\n",
         ":8: 'levels_per_dispatch' belongs to per = \"level\""},
        {head + buffer + "[[passes]]\nshader = \"build.comp\"\nper = \"pixel\"\nstyle = \"wide\"\n",
         ":8: unknown pass style 'wide' (known: parallel, serial)"},
        {head + buffer + "[[passes]]\nshader = \"build.comp\"\nper = \"pixel\"\nstyle = \"serial\"\n",
         ":5: passes of style \"serial\" need others of style \"parallel\" that make the same"}};
    const StructureDir dir;
    for (const Mistake& mistake : mistakes) {
        const std::string message = message_of<SpecError>([&] { load_structure(dir.add("tiles", mistake.manifest)); });
        EXPECT_THAT(message, HasSubstr("tiles/structure.toml:")) << mistake.manifest;
        EXPECT_THAT(message, HasSubstr(mistake.message)) << mistake.manifest;
    }
}

Structure reading(const std::string& id, const std::vector<std::string>& reads, SizeRule per = SizeRule::pixel)
{
    Structure structure;
    structure.id    = id;
    structure.reads = reads;
    structure.buffers.push_back({.name = id + "_buffer", .per = per, .count = 1, .tile_px = 0, .type = "uint"});
    return structure;
}

TEST(Structures, AreCollectedAfterWhatTheyRead)
{
    const Structure   known[] = {reading("c", {"a", "b"}), reading("b", {"a"}), reading("a", {}), reading("d", {})};
    const std::string ids[]   = {"c"};
    std::vector<std::string> names;
    for (const Structure& structure : collect_structures(ids, known, "t:1")) names.push_back(structure.id);
    EXPECT_THAT(names, ElementsAre("a", "b", "c"));
}

TEST(Structures, ThatCannotStandTogetherAreRefused)
{
    const Structure known[] = {reading("a", {"b"}), reading("b", {"a"}), reading("p", {}, SizeRule::depth_cell),
                               reading("q", {}, SizeRule::depth_cell), reading("x", {})};
    const auto      message = [&](std::vector<std::string> ids) {
        return message_of<SpecError>([&] { collect_structures(ids, known, "t:1"); });
    };
    EXPECT_THAT(message({"a"}), HasSubstr("t:1: structure 'a' reads itself"));
    EXPECT_THAT(message({"gone"}), HasSubstr("t:1: unknown structure 'gone'"));
    EXPECT_THAT(message({"p", "q"}), HasSubstr("t:1: 'p' and 'q' both keep their cells in the depth's buffer"));
    const Structure same[] = {known[4], [&] {
                                  Structure y = known[4];
                                  y.id        = "y";
                                  return y;
                              }()};
    EXPECT_THAT(message_of<SpecError>([&] {
                    collect_structures(std::vector<std::string>{"x", "y"}, same, "t:1");
                }),
                HasSubstr("t:1: 'x' and 'y' both have a buffer 'x_buffer'"));
}

TEST(Structures, AreFoundAlsoInTheFolderOfATechnique)
{
    const std::vector<std::filesystem::path> folders = {data_root() / "techniques/rivals"};
    std::vector<std::string>                 ids;
    for (const Structure& structure : load_catalogue(folders).structures) ids.push_back(structure.id);
    for (const char* id : {"depth_pyramid", "ray_packets", "front_packets"}) EXPECT_THAT(ids, testing::Contains(id));
}

} // namespace
} // namespace ssrlab
