// ssrlab sources: what each source of a list answers, how rightly and at what price.
#pragma once

#include "app/commands.h"

namespace ssrlab {

struct SourcesOptions {
    PictureOptions           picture; // output: a .csv to append to, or empty
    std::vector<std::string> lists;   // of sources, each "frame,world"
    std::string              hand_on = "uncertain";
};

/// Prints a table, and appends to a file in long form: a row for each source of each list.
int compare_sources(const CommonOptions& common, const SourcesOptions& options);

} // namespace ssrlab
