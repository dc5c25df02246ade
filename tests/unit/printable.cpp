// What files say must not move a terminal's cursor, nor turn its text.
#include "core/printable.h"
#include "test.h"

namespace ssrlab {
namespace {

TEST(Printable, TextStaysAsItIs)
{
    for (const char* text : {"", "scene.gltf: broken", "two\nlines\tand a tab", "Größe ≥ 1 … 𝄞", "\xC2\xA0"})
        EXPECT_EQ(printable(text), text);
}

TEST(Printable, WhatATerminalObeysIsSpelled)
{
    EXPECT_EQ(printable("a\x1B[2Jb\x07\x7F\r"), "a\\x1B[2Jb\\x07\\x7F\\x0D");
    EXPECT_EQ(printable(std::string_view("\0", 1)), "\\x00");
    EXPECT_EQ(printable("\xC2\x9B"), "\\xC2\\x9B") << "a control character of two bytes";
    EXPECT_EQ(printable("\xE2\x80\xAE"), "\\xE2\\x80\\xAE") << "writing from right to left";
}

TEST(Printable, WhatIsNoUtf8IsSpelled)
{
    EXPECT_EQ(printable("\xFF"), "\\xFF");
    EXPECT_EQ(printable("\x9B"), "\\x9B");
    EXPECT_EQ(printable("\xC3"), "\\xC3") << "cut";
    EXPECT_EQ(printable("\xE2\x80"), "\\xE2\\x80") << "cut";
    EXPECT_EQ(printable("\xC3("), "\\xC3(");
    EXPECT_EQ(printable("\xC0\x80"), "\\xC0\\x80") << "longer than it need be";
}

} // namespace
} // namespace ssrlab
