// In the place of this folder's other files where GLFW or Dear ImGui was not found.
#include "viewer/viewer.h"

#include "core/error.h"

namespace ssrlab {

int view_scene(const CommonOptions&, const ViewOptions&)
{
    throw_failure("this build has no viewer: install libglfw3-dev and libimgui-dev (sudo apt-get install libglfw3-dev "
                  "libimgui-dev), then configure and build again");
}

} // namespace ssrlab
