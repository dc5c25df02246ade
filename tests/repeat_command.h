// A test that fails says with which command to repeat it.
#pragma once

#include <string>

namespace ssrlab::test {

/// From now on; `program` is argv[0].
void print_repeat_commands(const std::string& program);

} // namespace ssrlab::test
