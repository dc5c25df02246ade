// ssrlab ray: one mirror ray, what each technique looked at, where and why it ended, and both truths.
#pragma once

#include "app/commands.h"

namespace ssrlab {

struct RayOptions {
    PictureOptions           picture; // output: a .json or .png, or empty
    std::vector<std::string> techniques;
    std::string              pixel;
    std::string              sources;      // a list to ask about the ray; empty: none
    bool                     json = false; // print JSON instead of the table
};

int explain_ray(const CommonOptions& common, const RayOptions& options);

} // namespace ssrlab
