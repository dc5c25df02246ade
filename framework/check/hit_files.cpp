#include "check/hit_files.h"

#include "core/error.h"
#include "scene/exr_file.h"

#include <cmath>
#include <optional>
#include <sstream>

namespace ssrlab {
namespace {

using Values = std::optional<std::vector<float>>;

/// The channel of that name, also at the end of a layer's name.
Values find_values(const ExrFile& file, const std::string& name, std::vector<std::string>* warnings = nullptr)
{
    const ExrChannel* found = nullptr;
    for (const ExrChannel& channel : file.channels)
        if (channel.name == name || (found == nullptr && channel.name.ends_with("." + name))) found = &channel;
    if (found != nullptr && found->is_half && warnings != nullptr)
        warnings->push_back(fmt::format("{}: {} is half, which rounds places by up to a pixel; export it as float",
                                        file.shown, found->name));
    return found != nullptr ? Values(read_channel(file, *found)) : std::nullopt;
}

/// Both channels or none.
std::pair<Values, Values> find_pair(const ExrFile& file, const std::string& layer, std::vector<std::string>& warnings)
{
    std::pair<Values, Values> pair{find_values(file, layer + ".x", &warnings),
                                   find_values(file, layer + ".y", &warnings)};
    if (pair.first.has_value() != pair.second.has_value())
        throw_spec_error("{}: expected both channels '{}.x' and '{}.y', got one of them", file.shown, layer, layer);
    return pair;
}

int whole(float value) { return std::abs(value) < 0x1p30F ? static_cast<int>(std::floor(value)) : -1; }

uint32_t counted(float value) { return value > 0 && value < 0x1p32F ? static_cast<uint32_t>(value) : 0; }

void set_statuses(HitsFile& hits, const Values& status, const Values& mask)
{
    for (size_t i = 0; i < hits.result.status.size(); ++i) {
        TraceStatus& to = hits.result.status[i];
        if (!status) {
            to = (*mask)[i] > 0 ? TraceStatus::hit : TraceStatus::left_screen;
            continue;
        }
        const float value = (*status)[i];
        const bool  known = value == std::floor(value) && value >= 0 && value < float(trace_status_names.size());
        to                = known ? static_cast<TraceStatus>(value) : TraceStatus::impossible;
        if (!known) hits.result.steps[i] = static_cast<uint32_t>(whole(value));
    }
}

void set_places(HitsFile& hits, const ExrFile& file)
{
    const auto   point = find_pair(file, "hit", hits.warnings), pixel = find_pair(file, "pixel", hits.warnings);
    const Values t = find_values(file, "hit.t", &hits.warnings), z = find_values(file, "hit.z"),
                 layer = find_values(file, "layer");
    if (!point.first && !pixel.first)
        throw_spec_error("{}: no hits: expected channels 'hit.x' and 'hit.y' or 'pixel.x' and 'pixel.y' "
                         "(docs/reference/hit_files.md)",
                         file.shown);
    hits.has_point = point.first.has_value();
    hits.has_pixel = pixel.first.has_value();
    hits.has_t     = t.has_value();
    hits.has_z     = z.has_value();
    const auto& x  = pixel.first ? *pixel.first : *point.first;
    const auto& y  = pixel.second ? *pixel.second : *point.second;
    for (size_t i = 0; i < x.size(); ++i) {
        TraceImage& result     = hits.result;
        result.hit_pixel[i]    = {whole(x[i]), whole(y[i])};
        result.hit_px_depth[i] = {hits.has_point ? (*point.first)[i] : 0.0F, hits.has_point ? (*point.second)[i] : 0.0F,
                                  z ? (*z)[i] : 0.0F};
        result.hit_t[i]     = t ? static_cast<double>((*t)[i]) : 0;
        result.hit_layer[i] = static_cast<uint8_t>(layer ? std::min(counted((*layer)[i]), 255U) : 0);
    }
}

/// Work is measured only where the file says it.
void set_work(HitsFile& hits, const ExrFile& file)
{
    const auto counts_of = [&](const char* name) {
        std::vector<uint32_t> counts;
        if (const Values values = find_values(file, name))
            for (const float value : *values) counts.push_back(counted(value));
        return counts;
    };
    const auto steps           = counts_of("steps");
    hits.has_steps             = !steps.empty();
    hits.result.depth_fetches  = counts_of("depth_fetches");
    const auto structure_reads = counts_of("structure_fetches");
    if (!structure_reads.empty()) hits.result.structure_fetches.push_back({"structures", structure_reads});
    for (size_t i = 0; i < steps.size(); ++i)
        if (hits.result.status[i] != TraceStatus::impossible) hits.result.steps[i] = steps[i];
}

} // namespace

Image hits_image(const TraceImage& result)
{
    Image image{result.size_px, {"hit.x", "hit.y", "hit.t", "hit.z", "pixel.x", "pixel.y", "layer", "status"}, {}, {}};
    const bool counted = !result.depth_fetches.empty();
    if (counted) image.channels.insert(image.channels.end(), {"steps", "depth_fetches", "structure_fetches"});
    for (size_t i = 0; i < result.status.size(); ++i) {
        const bool hit = has_place(result.status[i]);
        // A miss has no hit point: zeros, and the status says so. A stopped ray has one.
        const glm::dvec3 point = hit ? result.hit_px_depth[i] : glm::dvec3(0);
        const glm::dvec2 pixel = hit ? glm::dvec2(result.hit_pixel[i]) : glm::dvec2(0);
        for (const double value : {point.x, point.y, hit ? result.hit_t[i] : 0.0, point.z, pixel.x, pixel.y,
                                   hit ? double(result.hit_layer[i]) : 0.0, double(result.status[i])})
            image.values.push_back(static_cast<float>(value));
        if (!counted) continue;
        for (const uint32_t work : {result.steps[i], result.depth_fetches[i], structure_fetches_of(result, i)})
            image.values.push_back(static_cast<float>(work));
    }
    return image;
}

HitsFile read_hits(const std::filesystem::path& exr, glm::ivec2 size_px)
{
    const ExrFile file = open_exr(exr);
    if (file.size_px != size_px)
        throw_spec_error("{}: {}x{} pixels, expected {}x{} as the frame has", file.shown, file.size_px.x,
                         file.size_px.y, size_px.x, size_px.y);
    HitsFile     hits{file.shown, make_trace_image(size_px, false), true, true, true, true, true, true, file.attributes,
                  {}};
    const Values status = find_values(file, "status"), mask = find_values(file, "mask");
    if (!status && !mask)
        throw_spec_error("{}: nothing says which rays hit: expected a channel 'status' or 'mask' "
                         "(docs/reference/hit_files.md)",
                         file.shown);
    hits.has_status = status.has_value();
    set_statuses(hits, status, mask);
    set_places(hits, file);
    set_work(hits, file);
    return hits;
}

std::vector<std::string> stated_parameters(const HitsFile& hits)
{
    std::vector<std::string> pairs;
    const auto               found = hits.attributes.find("ssrlab:parameters");
    std::istringstream       text(found != hits.attributes.end() ? found->second : "");
    for (std::string pair; text >> pair;) pairs.push_back(pair);
    return pairs;
}

} // namespace ssrlab
