// ssrlab check: techniques against the catalogue of hard cases.
#pragma once

#include "app/commands.h"

namespace ssrlab {

struct HardCaseOptions {
    std::string              subject; // a technique's id, a folder of techniques, or empty: the tree's
    std::string              only_case;
    std::vector<std::string> parameters;   // name=value of every technique that is checked
    std::string              ray;          // "SETUP:RAY" of only_case: show it instead
    std::string              markdown;     // file for the table
    std::string              command_line; // which the file names
    bool                     quick     = false;
    bool                     stability = false; // also measure jitter and depth formats
};

/// 0, or 1 when a technique breaks what it claims.
int check_techniques(const CommonOptions& common, const HardCaseOptions& options);

} // namespace ssrlab
