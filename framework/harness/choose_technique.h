// The technique that `-t` names. "exact" stands for the fastest of those that return the pixel walk's answer.
#pragma once

#include "harness/choice.h"

namespace ssrlab {

struct AskedTechnique {
    const Technique* technique = nullptr; // of the catalogue
    Choice           choice;
};

/// Returns what `-t id` may mean: the technique of this name or, for "exact", all of the catalogue that claim to be
/// exact and have every parameter among `pairs` (name=value). Throws SpecError for wrong names and values, and if no
/// exact technique has all of them.
std::vector<AskedTechnique> asked_techniques(const Catalogue& catalogue, const std::string& id,
                                             const std::vector<std::string>& pairs);

/// Returns the technique itself if there is only one; of several the fastest on this device, at the size and surface of
/// the frame that the stage shows. If the cache does not know their times, they trace the frame's mirror rays in turn;
/// one whose hits differ from those of the first is left out. Says on stderr what it chose and why, unless `quiet`.
/// Throws Failure if none of them can trace the frame.
AskedTechnique choose_technique(Stage& stage, const std::vector<AskedTechnique>& asked, bool quiet);

} // namespace ssrlab
