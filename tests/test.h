// What every test has: the frameworks and the parts of the standard library that most use. Precompiled, because parsing
// these is most of what a test's file costs.
// Guarded by a macro: with #pragma once, g++ 12 has read this header again although it was precompiled.
#ifndef SSRLAB_TESTS_TEST_H
#define SSRLAB_TESTS_TEST_H

#include <fmt/format.h>
#include <glm/glm.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <ranges>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace ssrlab::test {

/// Row after row: each pixel's place in the list, and its column and row.
struct PixelPlace {
    size_t i;
    int    x, y;
};
inline std::vector<PixelPlace> pixels_of(glm::ivec2 size_px)
{
    std::vector<PixelPlace> pixels;
    for (int y = 0; y < size_px.y; ++y)
        for (int x = 0; x < size_px.x; ++x) pixels.push_back({pixels.size(), x, y});
    return pixels;
}

/// Expects of each name that what is found of it is the value that follows it.
template <typename Found, typename Value, typename... Rest>
void expect_each(const Found& found, const char* name, const Value& value, const Rest&... rest)
{
    EXPECT_EQ(found(name), value) << name;
    if constexpr (sizeof...(rest) > 0) expect_each(found, rest...);
}

} // namespace ssrlab::test

#endif
