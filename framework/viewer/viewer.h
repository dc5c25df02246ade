// ssrlab view: a window with one scene, in which everything that decides the picture can be changed.
#pragma once

#include "harness/choice.h"

namespace ssrlab {

struct ViewOptions {
    PictureOptions picture;
    std::string    script; // a file of commands (docs/how-to/viewer.md) in the place of mouse and keyboard; empty: none
};

int view_scene(const CommonOptions& common, const ViewOptions& options);

} // namespace ssrlab
