// ssrlab export: a technique as shaders for an engine, with their proof.
#pragma once

#include "harness/choice.h"

namespace ssrlab {

struct ExportOptions {
    PictureOptions           picture; // technique, parameters, folder to write; the scene's view decides the projection
    std::string              language;           // glsl, hlsl, msl, essl, wgsl
    std::vector<std::string> kept;               // parameters that stay specialization constants
    double                   near_m = 0;         // above 0: in the place of the view's
    std::string              verified;           // a folder whose shaders are run, instead of an export
    bool                     hard_cases = false; // export, run and compare every hard case; output: tables
    std::string              only_case;          // of them
};
int export_technique(const CommonOptions& common, const ExportOptions& options, const std::string& command_line);

} // namespace ssrlab
