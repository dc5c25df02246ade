// Loops in the assembly of AMD GPUs, counted by hand.
#include "core/error.h"
#include "gpu/compiled.h"
#include "test.h"

namespace ssrlab::test {
namespace {

TEST(ShaderLoops, TheLongestOneWithoutALoopWithinCounts)
{
    const LoopCode loop = innermost_loop("BB0:\n"
                                         "\ts_mov_b32 s0, 0 ; be800380\n"
                                         "\tbuffer_load_dword v0, v1, s[0:3], 0 idxen\n"
                                         "BB1:\n" // outer: 8 instructions, but it holds the next two
                                         "\tv_add_f32 v0, v1, v2\n"
                                         "BB2:\n" // 4 instructions, 2 loads
                                         "\timage_load v0, v[1:2], s[0:7] dmask:0x1\n"
                                         "\ts_waitcnt vmcnt(0)\n"
                                         "\tbuffer_load_dwordx2 v[0:1], v1, s[0:3], 0 idxen ; e0340000\n"
                                         "\ts_cbranch_execnz BB2 ; bf890000\n"
                                         "BB3:\n" // 2 instructions
                                         "\tv_sub_f32 v0, v1, v2\n"
                                         "\ts_cbranch_scc1 BB3\n"
                                         "\ts_branch BB1\n"
                                         "BB4:\n"
                                         "\tbuffer_store_dword v0, v1, s[0:3], 0 idxen\n"
                                         "\ts_endpgm\n");
    EXPECT_EQ(loop.instructions, 4);
    EXPECT_EQ(loop.loads, 2);
}

TEST(ShaderLoops, TwoWaysBackAreOneLoop)
{
    // "continue": both branches lead to the same block, and the shorter range is no loop within the longer one.
    const LoopCode loop = innermost_loop("BB1:\n"
                                         "\tglobal_load_dword v0, v[1:2], off\n"
                                         "\ts_cbranch_vccz BB1\n"
                                         "\tv_add_f32 v0, v1, v2\n"
                                         "\ts_branch BB1\n"
                                         "BB2:\n"
                                         "\ts_endpgm");
    EXPECT_EQ(loop.instructions, 4);
    EXPECT_EQ(loop.loads, 1);
}

TEST(ShaderLoops, ForwardBranchesAreNone)
{
    const LoopCode loop = innermost_loop("BB0:\n\ts_cbranch_execz BB2\nBB1:\n\tbuffer_load_dword v0, v1, s[0:3], 0\n"
                                         "BB2:\n\ts_endpgm\n");
    EXPECT_EQ(loop.instructions, 0);
    EXPECT_EQ(loop.loads, 0);
    EXPECT_EQ(innermost_loop("").instructions, 0);
}

TEST(Chips, AnUnknownOneIsAnsweredWithThoseThatAreKnown)
{
    try {
        pretend_chip("navi2");
        FAIL() << "accepted";
    } catch (const SpecError& error) {
        EXPECT_NE(std::string(error.what()).find("navi21"), std::string::npos) << error.what();
    }
}

} // namespace
} // namespace ssrlab::test
