// Plots are drawn by Python, with matplotlib.
#pragma once

#include <string>
#include <vector>

namespace ssrlab {

/// Runs a script of the project and waits. Throws Failure when it does not succeed.
void run_python(const std::string& script, const std::vector<std::string>& arguments);

} // namespace ssrlab
