// The device that all GPU tests share, opened with the validation layer.
#pragma once

#include "render/frame.h"

#include <gtest/gtest.h>

namespace ssrlab::test {

Gpu& device();

/// A technique of the tree by its id.
const Technique& technique(const std::string& id);

/// Its defaults with some values changed.
ParameterValues values_of(const Technique& technique, const ParameterValues& changed = {});

/// A scene, a view and its G-buffer on the device and on the host.
struct Picture {
    View            view;
    GBufferPtr      gbuffer;
    GBufferImage    image;
    FrameBuffersPtr buffers;
};
Picture make_picture(const std::string& scene, const std::string& view, glm::ivec2 size_px);

TraceResult trace(const Picture& picture, const Technique& technique, const ParameterValues& values, const TraceSettings& settings,
                  Precision precision = Precision::float32);

} // namespace ssrlab::test
