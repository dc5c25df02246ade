#include "scene/frame_channels.h"

#include <algorithm>
#include <cctype>

namespace ssrlab {
namespace {

/// "ViewLayer.Depth.Z": layer "viewlayerdepth", component "z".
struct ChannelName {
    std::string layer, component;
};

std::string plain(const std::string& text)
{
    std::string letters;
    for (const unsigned char c : text)
        if (std::isalnum(c) != 0) letters += static_cast<char>(std::tolower(c));
    return letters;
}

ChannelName split(const std::string& name)
{
    const size_t      dot  = name.rfind('.');
    const std::string last = dot == std::string::npos ? name : name.substr(dot + 1);
    const std::string rest = dot == std::string::npos ? "" : name.substr(0, dot);
    if (last.size() == 1) return {plain(rest), plain(last)};
    return {plain(name), ""};
}

/// A quantity is in a layer that is called so, or whose name ends so ("ViewLayer.Depth", "FinalImageWorldNormal").
struct Rule {
    std::string              quantity;   // without component
    std::vector<std::string> layers;     // "": no layer at all
    std::vector<std::string> components; // of a quantity with one component; the others have theirs
};

const std::vector<Rule>& rules()
{
    static const std::vector<Rule> all = {
        {"depth", {"depth", "depthz", "viewdistance", "raydistance"}, {"", "z", "r", "x", "v", "y", "t"}},
        {"normal", {"normal", "normals", "worldnormal", "normalvs", "normalws", "viewnormal"}, {}},
        {"roughness", {"roughness"}, {"", "r", "x", "v", "y"}},
        {"smoothness", {"smoothness"}, {"", "r", "x", "v", "y"}},
        {"metallic", {"metallic", "metalness", "metal"}, {"", "r", "x", "v", "y"}},
        {"specular", {"specular", "specularcolor", "specularcolour"}, {}},
        {"base_colour", {"basecolour", "basecolor", "albedo", "diffusecolor"}, {}},
        {"emission", {"emission", "emissive", "emit"}, {}},
        {"lit", {"", "rgba", "combined", "finalimage", "beauty", "finalcolor", "scenecolor", "lit"}, {}},
    };
    return all;
}

/// x is also called r, y g, z b, in both directions.
bool same_component(const std::string& wanted, const std::string& found)
{
    constexpr std::string_view axes = "xyz", colours = "rgb";
    if (wanted == found) return true;
    const size_t axis = axes.find(wanted), colour = colours.find(wanted);
    const size_t place = axis != std::string_view::npos ? axis : colour;
    return found.size() == 1 && (axes.find(found) == place || colours.find(found) == place);
}

bool named_by(const Rule& rule, const std::string& component, const ChannelName& name)
{
    const bool layer = std::ranges::any_of(rule.layers, [&](const std::string& ending) {
        return ending.empty() ? name.layer.empty() : name.layer.ends_with(ending);
    });
    // OpenEXR's own name for depth.
    if (rule.quantity == "depth" && name.layer.empty() && name.component == "z") return true;
    if (!layer || name.layer.find("denoising") != std::string::npos)
        return false; // Cycles' helpers: filtered, not at the centres
    if (name.layer.empty() && !component.empty()) return name.component == component; // Z is depth, and no blue
    return component.empty() ? std::ranges::find(rule.components, name.component) != rule.components.end()
                             : same_component(component, name.component);
}

} // namespace

std::vector<ExrChannel> find_quantity(std::span<const ExrChannel> channels, const std::string& quantity)
{
    const auto exact = std::ranges::find(channels, quantity, &ExrChannel::name);
    if (exact != channels.end()) return {*exact};
    const size_t            dot       = quantity.find('.');
    const std::string       base      = quantity.substr(0, dot);
    const std::string       component = dot == std::string::npos ? "" : plain(quantity.substr(dot + 1));
    const auto              rule      = std::ranges::find(rules(), base, &Rule::quantity);
    std::vector<ExrChannel> found;
    if (rule == rules().end()) return found;
    std::vector<std::string> layers; // of a layer with r, g and b of one number, the first counts
    for (const ExrChannel& channel : channels) {
        const ChannelName name = split(channel.name);
        if (!named_by(*rule, component, name) || std::ranges::find(layers, name.layer) != layers.end()) continue;
        layers.push_back(name.layer);
        found.push_back(channel);
    }
    return found;
}

std::string normal_space_of(const std::string& channel)
{
    const std::string layer = split(channel).layer;
    if (layer.find("world") != std::string::npos || layer.ends_with("ws")) return "world";
    if (layer.ends_with("vs") || layer.ends_with("viewnormal") || layer.ends_with("normalview")) return "view";
    return "";
}

} // namespace ssrlab
