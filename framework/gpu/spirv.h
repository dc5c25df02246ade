// Reading a SPIR-V module word by word.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace ssrlab {

inline constexpr size_t spirv_header_words = 5;

/// Calls visit(words) for each instruction of a module; its first word is words << 16 | opcode.
template <typename Visit> void for_each_instruction(std::span<const uint32_t> spirv, const Visit& visit)
{
    for (size_t first = spirv_header_words; first < spirv.size(); first += spirv[first] >> 16)
        visit(spirv.subspan(first, spirv[first] >> 16));
}

inline uint32_t opcode_of(std::span<const uint32_t> words) { return words[0] & 0xFFFF; }

} // namespace ssrlab
