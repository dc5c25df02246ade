// Writes a shader without the macros that only make it shorter to write. Folder-internal.
#pragma once

#include <string>
#include <string_view>

namespace ssrlab {

/// Replaces macros with parameters by what they stand for (engines' preprocessors lack ##), and those that stand for
/// one name or for nothing. Macros that name a number or an expression stay. `text` has no #if and no #include.
std::string expand_macros(std::string_view text);

} // namespace ssrlab
