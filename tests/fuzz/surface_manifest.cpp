#include "targets.h"

#include "trace/surface.h"

namespace ssrlab::fuzz {

void feed_surface_manifest(Bytes bytes)
{
    static const auto meeting = file_with("surface/meeting.glsl", Bytes()),
                      held    = file_with("surface/held.glsl", Bytes());
    load_surface(file_with("surface/surface.toml", bytes).parent_path());
}

} // namespace ssrlab::fuzz
