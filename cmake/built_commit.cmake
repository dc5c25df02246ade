# Writes OUTPUT, the commit of SOURCE as C++; the file stays as it is while that does not change, so that nothing is compiled again.
execute_process(COMMAND git -C ${SOURCE} rev-parse HEAD OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit "not known")
else()
  execute_process(COMMAND git -C ${SOURCE} status --porcelain --untracked-files=no OUTPUT_VARIABLE changes ERROR_QUIET)
  if(changes)
    string(APPEND commit " with changes")
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[
#include "core/version.h"

namespace ssrlab {

std::string built_commit() { return "@commit@"; }
std::string version_text() { return SSRLAB_VERSION " (" + built_commit() + ")"; }

} // namespace ssrlab
]] @ONLY)
