// What was built.
#pragma once

#include <string>

namespace ssrlab {

/// "0.1.0 (3ce6808…)".
std::string version_text();
/// The commit of the source tree when it was built, "… with changes" where files differ from it; "not known" without git.
std::string built_commit();

} // namespace ssrlab
