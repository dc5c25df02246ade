#include "targets.h"

#include "scene/frame_convention.h"

namespace ssrlab::fuzz {

void feed_frame_convention(Bytes bytes)
{
    static const ExrFile exr{file_with("convention.exr", Bytes()), "convention.exr", {64, 36}, {}, {}, {}};
    file_with("convention.exr.toml", bytes);
    read_convention(exr);
}

} // namespace ssrlab::fuzz
