// What each subcommand of ssrlab does. Each returns the exit code and throws SpecError (2) or Failure (1).
#pragma once

#include "core/image.h"
#include "harness/choice.h"

#include <string>

namespace ssrlab {

/// Prints techniques, surface models, scenes, settings and devices, a line each; or the catalogue as JSON.
int list_everything(const CommonOptions& common, bool json);
/// Prints every setting and parameter with its range, default and meaning, as Markdown tables.
int list_as_markdown(const CommonOptions& common);
/// Prints all about a technique, a surface model, or a setting of [trace] and [passes].
int show_entry(const CommonOptions& common, const std::string& name, bool json);
/// Returns a hit file (check/hit_files.h) that says how it was made. `parameters`: name=value.
Image hits_image(const TraceImage& result, const std::string& technique, const std::vector<std::string>& parameters);
/// Traces a frame and writes its hit file. If the scene is a folder that export_cases() wrote, traces each of its
/// frames and writes a folder of hit files.
int trace_hits(const CommonOptions& common, const PictureOptions& options);
int write_gbuffer(const CommonOptions& common, const PictureOptions& options);
/// Runs the plot script, which writes the plots, derived rows and report of a results folder. `bandwidth_gbps`: of the
/// device's memory; 0: not given.
int plot_results(const std::string& folder, double bandwidth_gbps);
/// Prints every column of a results folder with its unit and definition, as Markdown tables.
int print_measures(const CommonOptions& common);

} // namespace ssrlab
