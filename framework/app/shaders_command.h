// ssrlab shaders: what a GPU's compiler makes of the pipelines of a frame, without the GPU.
#pragma once

#include "app/commands.h"

namespace ssrlab {

struct ShadersOptions {
    std::vector<std::string> techniques;         // none: all
    std::vector<std::string> parameters;         // name=value; of every technique that has it
    std::string              chip;               // of AMD, by Mesa's compiler; empty: the device's own compiler
    std::string              assembly;           // folder for the assembly of each pipeline; empty: not written
    double                   bandwidth_gbps = 0; // of a card's memory; 0: not given
    bool                     json           = false;
    bool                     files          = false; // instead: what the compiler reads of each technique
};

int describe_shaders(const CommonOptions& common, const ShadersOptions& options);

} // namespace ssrlab
