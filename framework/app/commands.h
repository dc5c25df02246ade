// What each subcommand of ssrlab does. Each returns the exit code and throws SpecError (2) or Failure (1).
#pragma once

#include "core/image.h"
#include "harness/choice.h"

#include <string>

namespace ssrlab {

int list_everything(const CommonOptions& common, bool json);
/// Prints every setting and parameter with its range, default and meaning, as Markdown tables.
int list_as_markdown(const CommonOptions& common);
/// A technique, a surface model, or a setting of [trace] and [passes].
int show_entry(const CommonOptions& common, const std::string& name, bool json);
/// Returns a hit file (check/hit_files.h) that says how it was made. `parameters`: name=value.
Image hits_image(const TraceImage& result, const std::string& technique, const std::vector<std::string>& parameters);
/// Writes one. With a folder that export_cases() wrote as the scene: one for each of its frames, into a folder.
int trace_hits(const CommonOptions& common, const PictureOptions& options);
int write_gbuffer(const CommonOptions& common, const PictureOptions& options);
/// Plots, derived rows and report of a results folder, by the plot script. `bandwidth_gbps`: of the device's memory; 0:
/// not given.
int plot_results(const std::string& folder, double bandwidth_gbps);
/// Prints every column of a results folder with its unit and definition, as Markdown tables.
int print_measures(const CommonOptions& common);

} // namespace ssrlab
