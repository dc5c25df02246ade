#include "export/blocks.h"

#include "export/glsl_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <regex>
#include <vector>

namespace ssrlab {
namespace {

/// "layout(…) readonly buffer NAME { TYPE ARRAY[]; };"
struct Block {
    std::string declaration, layout, name, type, array;
    int         words      = 1; // of an element
    bool        is_written = true;
};

int words_of(const std::string& type)
{
    const char last = type.back();
    return last >= '2' && last <= '4' ? last - '0' : 1;
}

/// Blocks with one array of words, by their resource, in the order of the text.
std::map<std::string, std::vector<Block>> blocks_of(const std::string& text, const ResourceOf& resource_of)
{
    static const std::regex pattern(
        R"((layout\([^()]*\))\s*((?:(?:readonly|writeonly|coherent)\s+)*)buffer (\w+)\s*\{\s*(\w+) (\w+)\[\];\s*\};)");
    std::map<std::string, std::vector<Block>> blocks;
    for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match)
        blocks[resource_of(match->str(3))].push_back({match->str(), match->str(1), match->str(3), match->str(4),
                                                      match->str(5), words_of(match->str(4)),
                                                      match->str(2).find("readonly") == std::string::npos});
    return blocks;
}

void replace_first(std::string& text, const std::string& from, const std::string& to)
{
    text.replace(text.find(from), from.size(), to);
}

/// The closing bracket of the opening one at `at`.
size_t closing(const std::string& text, size_t at)
{
    int depth = 0;
    for (; at < text.size(); ++at) {
        if (text[at] == '[' || text[at] == '(') ++depth;
        if ((text[at] == ']' || text[at] == ')') && --depth == 0) return at;
    }
    return text.size();
}

/// How the words of a block lie in the array of all: as `words` elements of `held` words each.
std::string functions_of(const std::string& array, int words, int held)
{
    const std::string type = fmt::format("uvec{}", words);
    std::string       load, store;
    for (int i = 0; i < words / held; ++i) {
        const std::string place = fmt::format("{}[{} * at + {}]", array, words / held, i);
        load += fmt::format("{}{}", i == 0 ? "" : ", ", place);
        store += fmt::format(" {} = words.{};", place,
                             std::string("xyzw").substr(static_cast<size_t>(i) * static_cast<size_t>(held), held));
    }
    return fmt::format("{0} {1}_load_{2}(int at) {{ return {0}({3}); }}\n"
                       "void {1}_store_{2}(int at, {0} words) {{{4} }}\n",
                       type, array, words, load, store);
}

/// Each `ARRAY[index]` and `ARRAY[index] = value;` of the block, in the array of all.
void redirect(std::string& text, const Block& block, const std::string& array, int held)
{
    const bool        is_float = block.type == "float" || block.type.starts_with("vec");
    const bool        is_int   = block.type == "int" || block.type.starts_with("ivec");
    const std::string to_words = block.words > 1 ? fmt::format("uvec{}", block.words) : "uint";
    for (size_t at = text.find(block.array + "["); at != std::string::npos; at = text.find(block.array + "[", at)) {
        if (at > 0 && is_in_name(text[at - 1])) {
            ++at;
            continue;
        }
        const size_t      open = at + block.array.size(), close = closing(text, open);
        const std::string index  = text.substr(open + 1, close - open - 1);
        const size_t      equals = text.find_first_not_of(' ', close + 1);
        const bool        stores = text.compare(equals, 2, "= ") == 0;
        const size_t      end    = stores ? text.find(';', equals) : close + 1;
        std::string       value  = stores ? text.substr(equals + 2, end - equals - 2) : "";
        if (stores && is_float) value = fmt::format("floatBitsToUint({})", value);
        if (stores && is_int) value = fmt::format("{}({})", to_words, value);
        std::string now;
        if (block.words == held)
            now = fmt::format("{}[{}]{}", array, index, stores ? " = " + value : "");
        else if (stores)
            now = fmt::format("{}_store_{}(int({}), {})", array, block.words, index, value);
        else
            now = fmt::format("{}_load_{}(int({}))", array, block.words, index);
        if (!stores && is_float) now = fmt::format("uintBitsToFloat({})", now);
        if (!stores && is_int) now = fmt::format("{}({})", block.type, now);
        text.replace(at, end - at, now);
        ++at;
    }
}

/// One block in the place of several of one resource.
void merge(std::string& text, const std::string& resource, const std::vector<Block>& blocks)
{
    const std::string name = resource.substr(resource.find('.') + 1) + "_both", array = name + "_words";
    const int         held        = std::ranges::min(blocks, {}, &Block::words).words;
    std::string       declaration = fmt::format("{} buffer {} {{ {} {}[]; }};\n", blocks[0].layout, name,
                                          held == 1 ? "uint" : fmt::format("uvec{}", held), array);
    for (int words = 2 * held; words <= 4; words *= 2)
        if (std::ranges::count(blocks, words, &Block::words) > 0) declaration += functions_of(array, words, held);
    for (const Block& block : blocks) {
        replace_first(text, block.declaration, &block == &blocks.front() ? declaration : "");
        redirect(text, block, array, held);
    }
}

} // namespace

std::string with_one_block_where_written(const std::string& glsl, const ResourceOf& resource_of)
{
    std::string text = glsl;
    for (const auto& [resource, blocks] : blocks_of(glsl, resource_of))
        if (blocks.size() > 1 && std::ranges::count(blocks, true, &Block::is_written) > 0)
            merge(text, resource, blocks);
    return text;
}

} // namespace ssrlab
