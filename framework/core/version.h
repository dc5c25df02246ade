// Version and commit of the program.
#pragma once

#include <string>

namespace ssrlab {

/// "0.1.0 (3ce6808…)".
std::string version_text();
/// Returns the commit at build time, "… with changes" if files differed, "not known" without git.
std::string built_commit();

} // namespace ssrlab
