// Two kinds of error: the user wrote something wrong, or the machine could not do it.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace ssrlab {

/// Wrong usage or specification. The message names file, place, what was expected and what was found. Exit code 2.
struct SpecError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The specification is fine but the work failed: device, disk, damaged file. Exit code 1.
struct Failure : std::runtime_error {
    using std::runtime_error::runtime_error;
};

template <typename... Args> [[noreturn]] void throw_spec_error(fmt::format_string<Args...> format, Args&&... args)
{
    throw SpecError(fmt::format(format, std::forward<Args>(args)...));
}

template <typename... Args> [[noreturn]] void throw_failure(fmt::format_string<Args...> format, Args&&... args)
{
    throw Failure(fmt::format(format, std::forward<Args>(args)...));
}

} // namespace ssrlab
