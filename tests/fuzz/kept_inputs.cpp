// Inputs with which a target failed once, fed to it again without the fuzzer: tests/fuzz/kept/TARGET/NAME.bin.
#include "core/error.h"
#include "core/files.h"
#include "targets.h"
#include "test.h"

namespace ssrlab::fuzz {
namespace {

const std::map<std::string, void (*)(Bytes)> targets = {
    {"toml", feed_toml},
    {"experiment", feed_experiment},
    {"technique_manifest", feed_technique_manifest},
    {"structure_manifest", feed_structure_manifest},
    {"surface_manifest", feed_surface_manifest},
    {"reprojection_manifest", feed_reprojection_manifest},
    {"recipe", feed_recipe},
    {"views", feed_views},
    {"frame_convention", feed_frame_convention},
    {"frame", feed_frame},
    {"environment_exr", feed_environment_exr},
    {"environment_hdr", feed_environment_hdr},
    {"gltf", feed_gltf},
    {"obj", feed_obj},
    {"image", feed_image},
};

class KeptInputs : public ::testing::TestWithParam<std::filesystem::path> {};

TEST_P(KeptInputs, AreTakenOrRefused)
{
    const auto target = targets.find(GetParam().parent_path().filename().string());
    ASSERT_NE(target, targets.end()) << "no target is called as the folder";
    const std::string text = read_file(GetParam());
    try {
        target->second({reinterpret_cast<const unsigned char*>(text.data()), text.size()});
    } catch (const SpecError& error) {
        EXPECT_STRNE(error.what(), "");
    } catch (const Failure& error) {
        EXPECT_STRNE(error.what(), "");
    }
}

std::vector<std::filesystem::path> kept()
{
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(data_root() / "tests/fuzz/kept"))
        if (entry.is_regular_file()) files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

std::string name_of(const ::testing::TestParamInfo<std::filesystem::path>& info)
{
    std::string name = info.param.parent_path().filename().string() + "_" + info.param.filename().string();
    std::ranges::replace_if(
        name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(Files, KeptInputs, ::testing::ValuesIn(kept()), name_of);

} // namespace
} // namespace ssrlab::fuzz
