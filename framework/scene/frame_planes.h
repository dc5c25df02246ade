// The planes of numbers that an imported frame is made of. Folder-internal.
#pragma once

#include "scene/frame_convention.h"
#include "scene/load_frame.h"

#include <optional>

namespace ssrlab {

struct FramePlane {
    std::string        shown; // "FILE: channel 'NAME'"
    std::string        name;
    std::vector<float> values;
    bool               is_half = false;
    ExrWindow          window  = {}; // where the file has values; elsewhere they are 0
};

/// A frame while it is read.
struct FrameSource {
    ExrFile         file;
    FrameConvention convention;
    Frame           frame;
};

/// Finds what holds the quantity (frame_channels.h): the channel that the convention names, a recognised one, or a
/// constant. Throws SpecError if two channels could be it.
std::optional<FramePlane> find_plane(const FrameSource& source, const std::string& quantity);
/// The same; throws SpecError if there is none. `elsewhere` says where else it could be stated.
FramePlane need_plane(const FrameSource& source, const std::string& quantity, const char* elsewhere = "");

/// Makes the pixels outside the plane's window background, since a part of their surface is unknown.
void clear_outside(FrameSource& source, const FramePlane& plane);

/// Fills the unit normals in view space. Needs depth. Throws SpecError for values that cannot be normals.
void read_normals(FrameSource& source);

/// Throws SpecError with file, channel, what was expected and what was found.
[[noreturn]] void refuse(const FrameSource& source, const FramePlane& plane, size_t i, const char* expected);

} // namespace ssrlab
