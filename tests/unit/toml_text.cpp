// What is refused of a TOML file's bytes before toml++ sees them.
#include "core/toml_reading.h"
#include "errors.h"
#include "test.h"

namespace ssrlab {
namespace {

using testing::HasSubstr;

std::string refused(const std::string& text)
{
    return message_of<SpecError>([&] { parse_toml("file.toml", text); });
}

std::string value_of(const std::string& text)
{
    return parse_toml("file.toml", text).root["a"].value_or(std::string());
}

TEST(TomlText, LettersStandInStringsAndComments)
{
    EXPECT_EQ(value_of("\xEF\xBB\xBF# é\na = \"é\" # ü"), "é");
    EXPECT_EQ(value_of("a = 'é\\' # ü\n'b é' = 1"), "é\\");
    EXPECT_EQ(value_of("a = \"\"\"\né \\\" é\n\\\n  x é\"\"\"\"\" # ü"), "é \" é\nx é\"\"");
    EXPECT_EQ(value_of("a = '''\né\\\n'é''''"), "é\\\n'é'");
    EXPECT_EQ(value_of("a = \"\\\\\" # é"), "\\");
    EXPECT_EQ(value_of("\"é\"=1\nb=[\"é\",'é']\nc={\"é\"=1,'ü'=2}\nd.\"é\"=3\n['ö'.\"ü\"]\n"), "");
    EXPECT_EQ(value_of("b = [{}, {c = 1.5, d.\"é\" = 2}, [\n-1, 'ü',\n], ]\ne = 1\nf.\"é\"=1979-05-27 07:32:00 # "
                       "ü\n[[g]]\n\"ä\" = inf\nh.'é' = {i = true, \"é\"=\"é\"}"),
              "");
    EXPECT_EQ(value_of("a = \"\"\"\\\n  \\u00e9\"\"\""), "é");
    EXPECT_EQ(value_of("a = \"\xED\x9F\xBF\xEE\x80\x80\xF0\x90\x80\x80\xF4\x8F\xBF\xBF\""),
              "\xED\x9F\xBF\xEE\x80\x80\xF0\x90\x80\x80\xF4\x8F\xBF\xBF");
}

TEST(TomlText, KeysOfManyPartsAreRefused)
{
    const auto key = [](size_t parts) {
        std::string text = "a";
        for (size_t i = 1; i < parts; ++i) text += i % 2 == 0 ? ".a" : ".\"a.b\"";
        return text;
    };
    EXPECT_EQ(value_of("[" + key(101) + "]\nb = { " + key(101) + " = 1.5 }\n"), "");
    for (const std::string& text :
         {key(102) + " = 1", "[" + key(300'000) + "]", "b = { c = 1, " + key(300'000) + " = 1 }"})
        EXPECT_THAT(refused("# é\n" + text), HasSubstr("file.toml:2: expected a key of at most 101 parts"));
}

TEST(TomlText, WhatIsNotUtf8IsRefusedWithItsLine)
{
    const char* broken[] = {
        "\xFF",         "\x80",         "\xC3",         "\xC3(",        "\xC0\xAF",         "\xC1\xBF",
        "\xE0\x9F\xBF", "\xE2\x82",     "\xE2(\x82",    "\xED\xA0\x80", "\xF0\x8F\xBF\xBF", "\xF4\x90\x80\x80",
        "\xF5\x80\x80", "\xF0\x9F\x98", "\xF0\x9F\x98!"};
    for (const std::string bytes : broken) {
        const std::string expected =
            fmt::format("file.toml:2: expected UTF-8, got the byte 0x{:02x}", static_cast<unsigned char>(bytes[0]));
        EXPECT_EQ(refused("a = 1\nb = \"" + bytes + "\"\n"), expected);
        EXPECT_EQ(refused("a = 1\n# " + bytes), expected);
    }
}

TEST(TomlText, LettersElsewhereAreRefusedWithTheirLine)
{
    for (const char* text :
         {"é = 1",        "a é= 1",         "a = é",        "a = 1 é",          "a = \"x\"é",    "[é]",
          "a.é = 1",      "a = [1, é]",     "a = {é = 1}",  "a = 1\n\né",       "a = '''x''''é", "a = \"\"\"x\"\"\"\"é",
          "a = \"x\né",   "'é\né",          "a = 0\"é\"",   "a = -'é'",         "a = 0.\"é\"",   "a = 0=\"é\"",
          "a = [0[\"é\"", "a = {b = 0{'é'", "a = [\n1.'é'", "a = [1979'''é''']"})
        EXPECT_THAT(refused(text), HasSubstr("expected ASCII outside quotes and comments, got 'é'")) << text;
    EXPECT_THAT(refused("a = 1\n\n é"), HasSubstr("file.toml:3: "));
    for (const char* text : {"a = \"\"\"\\é\"\"\"", "a = \"\"\"\\\né\"\"\"", "a = \"\"\"x\\ \t\r\n\n  é\"\"\""})
        EXPECT_THAT(refused(text), HasSubstr("expected ASCII after a backslash, or after a line that ends with one"))
            << text;
    EXPECT_THAT(refused("a = \v"), HasSubstr("file.toml:1: "));
    EXPECT_THAT(refused("a = \f\"é\""), HasSubstr("file.toml:1: "));
    EXPECT_THAT(refused("a = \"x"), HasSubstr("file.toml:1: "));
    EXPECT_THAT(refused("a = \"\"\"\\"), HasSubstr("file.toml:1: "));
    EXPECT_THAT(refused("a = \"\\"), HasSubstr("file.toml:1: "));
}

} // namespace
} // namespace ssrlab
