// What passes declare to read and write, and what they get.
#include "frame/passes/pass_helpers.h"
#include "gpu/device.h"

namespace ssrlab::test {
namespace {

/// All that a frame does with this pass, as its error says; empty: nothing is wrong.
std::string error_of(const FrameInputs& inputs, const Pass& pass)
{
    try {
        pass.prepare(device(), {inputs, pass, pass.id});
    } catch (const std::logic_error& error) {
        return error.what();
    }
    return "";
}

TEST(DeclaredResources, AReadThatIsNotDeclaredIsRefused)
{
    const FrameSettings settings;
    const Picture       picture = make_picture("builtin:everything", "default", {64, 36});
    const FramePtr frame = prepared_frame(picture.buffers, technique("hiz"), values_of(technique("hiz")), settings);
    const std::pair<Pass, std::vector<Resource>> passes[] = {
        {hit_colour_pass(), {Resource::gbuffer, Resource::light, Resource::rays, Resource::hits}},
        {ray_reuse_pass(), {Resource::gbuffer, Resource::tiles, Resource::lobe_rays}},
        {environment_pass(), {Resource::gbuffer, Resource::surroundings, Resource::tiles}},
        {trace_pass(), {Resource::rays}},
        {composite_pass(), {Resource::gbuffer, Resource::light}}};
    for (const auto& [pass, reads] : passes) {
        EXPECT_EQ(error_of(frame->inputs, pass), "");
        for (const Resource read : reads) {
            Pass silent = pass;
            ASSERT_EQ(std::erase(silent.reads, read), 1U) << pass.id << " " << name_of(read);
            EXPECT_THAT(error_of(frame->inputs, silent), testing::HasSubstr("the pass " + pass.id)) << name_of(read);
        }
    }
}

TEST(DeclaredResources, AWriteThatIsNotDeclaredIsRefused)
{
    const FrameSettings settings;
    const Picture       picture = make_picture("builtin:everything", "default", {64, 36});
    const FramePtr frame  = prepared_frame(picture.buffers, technique("hiz"), values_of(technique("hiz")), settings);
    Pass           silent = composite_pass();
    ASSERT_EQ(std::erase(silent.writes, Resource::shaded), 1U);
    EXPECT_THAT(error_of(frame->inputs, silent), testing::HasSubstr("the pass composite"));
}

// In the order of a frame: what a pass reads was there before the first one, or an earlier one wrote it.
TEST(DeclaredResources, ComeFromEarlierPasses)
{
    std::set<Resource> there{Resource::gbuffer, Resource::light, Resource::objects, Resource::surroundings,
                             Resource::history};
    for (const Pass& pass : all_passes()) {
        for (const Resource read : pass.reads) EXPECT_TRUE(there.contains(read)) << pass.id << " " << name_of(read);
        there.insert(pass.writes.begin(), pass.writes.end());
    }
    EXPECT_TRUE(there.contains(Resource::shaded));
}

} // namespace
} // namespace ssrlab::test
