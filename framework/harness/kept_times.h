// Times of techniques on a device, kept in the user's cache folder: one JSON file for each device.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace ssrlab {

/// One measurement of several techniques.
struct KeptTimes {
    std::string                        frame;    // "640x360, plane_solid": what the techniques were measured at
    std::string                        state;    // hash of everything else that the times depend on
    size_t                             rays = 0; // that each of them traced
    std::map<std::string, double>      ms;       // by technique: structures and trace
    std::map<std::string, std::string> left_out; // the other techniques, and why
};

/// Returns the device's file, which need not exist; empty without a cache folder.
std::filesystem::path kept_times_file(const std::string& device);

/// Returns all measurements in the file; none if it does not exist. Throws SpecError, with the place or the reason, if
/// it is damaged.
std::vector<KeptTimes> read_kept_times(const std::filesystem::path& file);

/// Throws Failure if the file cannot be written.
void write_kept_times(const std::filesystem::path& file, const std::string& device,
                      const std::vector<KeptTimes>& measurements);

} // namespace ssrlab
