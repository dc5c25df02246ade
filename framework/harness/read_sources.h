// The table [sources] of a specification, and the key `sources` of its techniques. Folder-internal: needs toml++.
#pragma once

#include "core/toml_reading.h"
#include "harness/experiment.h"

namespace ssrlab {

/// Returns every list with every value of hand_on, or one entry without a list if there is no table. Throws SpecError
/// for what is unknown, and if there will be no truths to judge by.
std::vector<AskedSources> read_sources(const TomlFile& file, const MeasureSettings& measure);

/// Returns the lists of `node`, one text or several, each with every value of `hand_on`. Throws likewise.
std::vector<AskedSources> read_source_lists(const TomlFile& file, const toml::node& node, const std::string& key,
                                            std::span<const HandOn> hand_on, const MeasureSettings& measure);

} // namespace ssrlab
