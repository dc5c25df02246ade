// What `ssrlab judge` says of one hits file.
#pragma once

#include "check/judge_frame.h"
#include "harness/record.h"

#include <nlohmann/json.hpp>

#include <optional>

namespace ssrlab {

/// One hits file, judged.
struct Judged {
    std::string              frame, hits;
    glm::ivec2               size_px{0, 0};
    std::vector<std::string> settings; // name=value
    FrameJudgement           judgement;
    Record                   measures; // the columns of results.csv that a run would have
    bool                     has_scene = false;
    std::optional<double>    f1; // of the scene truth, else of the screen truth; none: nothing is to be hit, nor is it
};

nlohmann::ordered_json json_of(const Judged& judged);
void                   print(const Judged& judged);

/// Prints the first few.
void print_findings(const std::vector<Finding>& findings);
/// " (missed 3, too_late 1)", or nothing.
std::string fault_counts(const FrameJudgement& judgement);

} // namespace ssrlab
