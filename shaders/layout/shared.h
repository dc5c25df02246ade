// Numbers, and places in memory, that C++ and GLSL must agree on, for C++. Shaders include the parts.
#pragma once
#define SHARED_FUNCTION inline // shaders define it as nothing
// clang-format off: each needs those before it
#include "numbers.h"
#include "places.h"
#include "cell_index.h"
#include "frame_shared.h"
// clang-format on
