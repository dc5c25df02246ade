// Leaves out what a shader declares and does not use. Folder-internal.
#pragma once

#include <string>
#include <string_view>

namespace ssrlab {

/// Leaves out the statements that call functions without a body, such as counters that are compiled out.
std::string without_empty_calls(std::string_view text);

/// Keeps main() and what it reaches by name, each with the comment before it. `text` has no #if.
std::string without_unused(std::string_view text);

} // namespace ssrlab
