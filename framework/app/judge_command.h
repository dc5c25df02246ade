// ssrlab judge: the hits of any renderer against the hit contract and the truths.
#pragma once

#include "app/commands.h"

#include <optional>

namespace ssrlab {

struct JudgeOptions {
    std::string              frame, hits; // files, or the folder of export-cases and one with a hits file for each case
    std::string              scene;       // with triangles, or empty
    int                      at_frame = 0; // of the scene's motion
    std::vector<std::string> parameters;   // name=value: settings of [trace]
    std::string              output;       // .png, or empty
    std::string              show    = "agreement";
    bool                     json    = false;
    bool                     partial = false; // of a folder: cases without hits do not fail
    std::optional<double>    min_f1;
};

/// Prints what is right and wrong. 0, or 1 if an answer is impossible or F1 is below min_f1; of a folder also if a ray
/// is wrong and min_f1 is not given, or if a case has no hits and `partial` is not set.
int judge_hits(const CommonOptions& common, const JudgeOptions& options);

} // namespace ssrlab
