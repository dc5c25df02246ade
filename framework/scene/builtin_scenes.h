// Analytic scenes: their reflections have closed forms, so tests know the answer.
#pragma once

#include "scene/model.h"

#include <span>

namespace ssrlab {

struct BuiltinScene {
    const char* name; // without "builtin:"
    const char* summary;
    Model (*make)();
};

std::span<const BuiltinScene> builtin_scenes();

} // namespace ssrlab
