// What an export says of itself.
#include "core/version.h"
#include "export/passes.h"
#include "shared.h"

#include <fmt/format.h>

#include <regex>

namespace ssrlab {
namespace {

bool uses(std::span<const ExportedPass> passes, const std::string& resource)
{
    for (const ExportedPass& pass : passes)
        for (const auto& [binding, name] : pass.bindings)
            if (name == resource) return true;
    return false;
}

std::string projection_text(const View& view)
{
    if (view.projection == Projection::perspective)
        return fmt::format("a perspective view with near_m = {:g}; depth = near_m / distance, 0 for the sky",
                           view.near_m);
    return fmt::format("an orthographic view with near_m = {:g} and far_m = {:g}; "
                       "depth = (far_m - distance) / (far_m - near_m), 0 for the sky",
                       view.near_m, view.far_m);
}

/// What host_depth() returns for the depths of engines.
std::string depth_text(const View& view)
{
    if (view.projection != Projection::perspective) return "";
    return "## Your depth\n"
           "The shaders read `near_m / distance`: reversed depth with an infinite far plane. "
           "With device depth `d`, `n = near_m` and a far plane at `f`, `host_depth()` returns:\n\n"
           "| depth buffer | sky | returns |\n|---|---|---|\n"
           "| reversed | `d = 0` | `d == 0 ? 0 : d * (1 - n / f) + n / f` |\n"
           "| standard | `d = 1` | `d == 1 ? 0 : (1 - d) * (1 - n / f) + n / f` |\n"
           "| distance along the view axis | yours | `n / distance`, and 0 for the sky |\n\n"
           "With an infinite far plane `n / f` is 0. "
           "Pixels count from the top left: turn images whose first row is the lowest one.\n\n";
}

std::string settings_text(const Export& what, const char* line)
{
    std::string text;
    for (const auto& [name, value] : what.chosen)
        text += fmt::format(fmt::runtime(line), name,
                            what.kept.contains(name) ? value + ", unless the host sets it" : value);
    return text;
}

/// A constant that stays one of the pipeline: "layout(constant_id = 32) const int steps = 500;".
struct KeptConstant {
    std::string id, type, value;
};

/// By its name. A number that no pass uses is in none.
std::map<std::string, KeptConstant> kept_constants(std::span<const ExportedPass> passes)
{
    static const std::regex             pattern(R"(layout\(constant_id = (\d+)\) const (\w+) (\w+) = ([^;]+);)");
    std::map<std::string, KeptConstant> found;
    for (const ExportedPass& pass : passes)
        for (std::sregex_iterator match(pass.glsl.begin(), pass.glsl.end(), pattern), end; match != end; ++match)
            found[match->str(3)] = {match->str(1), match->str(2), match->str(4)};
    return found;
}

/// How the host sets the constant of this id.
std::string setting_of_constant(ExportLanguage language, const std::string& id)
{
    switch (language) {
    case ExportLanguage::glsl: return fmt::format("`constantID = {}` of a `VkSpecializationMapEntry`", id);
    case ExportLanguage::hlsl: return fmt::format("`-D SPIRV_CROSS_CONSTANT_ID_{}=VALUE` for the compiler", id);
    case ExportLanguage::msl:
        return fmt::format("`setConstantValue:type:atIndex:{}` of `MTLFunctionConstantValues`", id);
    case ExportLanguage::essl:
        return fmt::format("`#define SPIRV_CROSS_CONSTANT_ID_{} VALUE` behind the line `#version`", id);
    case ExportLanguage::wgsl: return fmt::format("`constants: {{ {}: VALUE }}` of `createComputePipeline()`", id);
    }
    return "";
}

std::string constants_text(const Export& what, std::span<const ExportedPass> passes)
{
    if (what.kept.empty()) return "";
    const auto  constants = kept_constants(passes);
    std::string text      = "## Constants that the host sets\n"
                            "Each has one value in all passes that declare it. Nothing checks the range. "
                            "`expected/` holds for the defaults.\n\n"
                            "| name | id | type | default | range | set by |\n|---|---|---|---|---|---|\n";
    for (const Parameter& parameter : what.technique.parameters) {
        if (!what.kept.contains(parameter.name)) continue;
        const auto        found = constants.find(parameter.name);
        const std::string range = fmt::format("{} to {}", format_parameter(parameter, parameter.min),
                                              format_parameter(parameter, parameter.max));
        if (found == constants.end())
            text += fmt::format("| `{}` | none: no pass uses it | | | {} | |\n", parameter.name, range);
        else
            text +=
                fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", parameter.name, found->second.id, found->second.type,
                            found->second.value, range, setting_of_constant(what.language, found->second.id));
    }
    return text + "\n";
}

std::string dispatch_text(const ExportedPass& pass)
{
    if (pass.pass.rays_per_workgroup == 0) return pass.pass.rule;
    return fmt::format("{0} rays a workgroup: {1} x ceil(rays / {2}) workgroups. "
                       "`rays` may be the number of pixels: workgroups beyond `ray_count` do nothing",
                       pass.pass.rays_per_workgroup, LAUNCH_ROW_GROUPS,
                       pass.pass.rays_per_workgroup * LAUNCH_ROW_GROUPS);
}

/// "10", or the register "t10".
std::string place_of(const ExportedPass& pass, uint32_t binding)
{
    const auto found = pass.registers.find(binding);
    return found == pass.registers.end() ? std::to_string(binding) : found->second;
}

std::string passes_table(std::span<const ExportedPass> passes, ExportLanguage language)
{
    std::string text = "| file | workgroups, rounded up | bindings |\n|---|---|---|\n";
    for (const ExportedPass& pass : passes) {
        std::string bindings;
        for (const auto& [binding, resource] : pass.bindings)
            bindings += fmt::format("{}{} `{}`", bindings.empty() ? "" : ", ", place_of(pass, binding), resource);
        text += fmt::format("| `{}{}` | {} | {} |\n", pass.name, file_ending(language), dispatch_text(pass), bindings);
    }
    return text;
}

/// What the numbers of the bindings are.
const char* bindings_text(ExportLanguage language)
{
    switch (language) {
    case ExportLanguage::glsl: return "Bindings are those of set 0.";
    case ExportLanguage::hlsl:
        return "Bindings are registers of space0: "
               "t for a shader resource view, u for an unordered access view, b for a constant buffer. "
               "Buffers are raw (`ByteAddressBuffer`), images textures. "
               "No dispatch binds a resource twice where it writes it. "
               "One that is u in a pass and t in the next changes its state between them.";
    case ExportLanguage::msl: return "Bindings are those of `[[buffer(N)]]` and `[[texture(N)]]`.";
    case ExportLanguage::essl: return "Bindings are those of `layout(binding = N)`.";
    case ExportLanguage::wgsl: return "Bindings are those of group 0.";
    }
    return "";
}

constexpr const char* view_text =
    "uniform block of 48 bytes: `ivec2 size_px`, "
    "`vec2 focal_px` (pixels per unit of slope: width / 2 / tan(fov_x / 2); orthographic: per metre), "
    "`vec2 centre_px` (where the view axis meets the image), "
    "`vec2 focal_low_px`, `vec2 centre_low_px` (what rounding to float took from the two; 0 will do), "
    "`float near_m`, `float far_m`";

constexpr const char* gradient_text =
    "a word for each pixel, in rows from the top: how depth changes from one pixel to the next "
    "along x (upper 16 bits) and y (lower 16 bits), each the upper half of a float, rounded to nearest; "
    "all bits set where there is no plane. "
    "From a geometric normal n in view space: `depth * (n.x / focal.x, -n.y / focal.y) / dot(n, v)` "
    "with v = (x, y, -1) toward the pixel's centre and `|dot(n, v)| >= 0.02 |n| |v|`; "
    "orthographic: `-(n.x / focal.x, -n.y / focal.y) / n.z / (far - near)`";

std::string resources_table(std::span<const ExportedPass> passes, const ComposedLab& composed)
{
    std::string text = "| resource | what it holds |\n|---|---|\n";
    const auto  row  = [&](const std::string& name, const std::string& what) {
        if (uses(passes, name)) text += fmt::format("| `{}` | {} |\n", name, what);
    };
    row("view", view_text);
    row("host_depth", "your depth: a float for each pixel, in rows from the top. "
                      "To read a texture or another convention, change `host_depth()` in the first file");
    row("host_gradients", gradient_text);
    row("normals", "image of format rgba32f: the normal in view space (x right, y up, looking along -z), any length");
    row("solids", "image of format r32f: the depth where the solid behind the pixel ends; 0: it is thin");
    row("cells", "depth, and what structures know above it: 8 bytes times "
                 "`(((w - 1) >> 4) + 1) * odd(2^ceil(log2(h)) + h + 1) * 8 + (((w - 1) >> 3) + 1) * odd(h + 1) * 8` "
                 "for an image of w x h pixels, where odd(n) is n, or n + 1 if n is even. "
                 "Fill it with the float -1 before the first frame, and when the size of the image changes");
    row("ray_count", "one word: the number of rays, at most one for each pixel. "
                     "Set it to 0 before the ray set-up, or to the length of your own list");
    row("rays", "32 bytes a ray: x_px, y_px and depth where it starts, its length in metres, "
                "the same three from there to its end, and a word: "
                "pixel x in bits 0-13, y in 14-27, and above them the status of a ray that hits nothing. "
                "The segment lies on the image");
    row("hits",
        "8 bytes a ray: a word with pixel x in bits 0-13, y in 14-27 and the status above them; and the float t");
    row("push", "uniform block: two ints, `level` and `last_level`, for each dispatch its own");
    for (const ComposedBuffer& buffer : composed.buffers)
        row(buffer.structure + "." + buffer.name, buffer.rule + ", as words of 32 bits");
    return text;
}

constexpr const char* statuses =
    "1 hit: `t` and the pixel say where. 2 left the screen. 3 reached the maximum distance. "
    "4 out of steps: unknown, never a hit. 5 met only surfaces that face away. "
    "6 stopped behind what the frame shows: unknown, and `t` and the pixel say where. "
    "7 an answer that cannot be: a bug.";

} // namespace

std::string head_comment(const Export& what, const View& view, const ExportedPass& trace)
{
    return fmt::format(
        "// {}: {}\n"
        "// {}\n//\n"
        "// SPDX-License-Identifier: MIT. Copyright (c) 2026 the ssrlab authors\n"
        "// Written by ssrlab {}: {}\n//\n"
        "// Made for {}.\n"
        "// Settings:{}\n//\n"
        "// The host provides View, the depth that the passes before this one laid out, and the list of rays:\n"
        "//   Rays      origin (x_px, y_px, depth), length_m, delta to the end of the segment, "
        "pixel and status of a miss\n"
        "//   RayCount  how many; {} rays a workgroup, workgroups in rows of {}\n"
        "// and gets of each ray:\n"
        "//   Hits      x in bits 0-13, y in 14-27, status in 28-31; and t: 0 at the ray's origin, 1 at its end\n"
        "// Status: 1 hit, 2 left the screen, 3 maximum distance, 4 out of steps (no hit), "
        "5 met surfaces that face away only,\n"
        "// 6 stopped behind what the frame shows (no hit). The point of a hit is origin + t * delta.\n"
        "// README.md has all formats, the dispatches and the cost.\n",
        trace.name, what.technique.name, what.technique.summary, version_text(), what.command, projection_text(view),
        settings_text(what, "\n//   {} = {}"), trace.pass.rays_per_workgroup, LAUNCH_ROW_GROUPS);
}

std::string readme(const Export& what, const View& view, std::span<const ExportedPass> passes,
                   const ComposedLab& composed, const Cost& cost)
{
    std::string text = fmt::format("# {}\n{}\n\n", what.technique.name, what.technique.summary);
    for (const std::string& cite : what.technique.cite) text += fmt::format("- {}\n", cite);
    text +=
        fmt::format("\nMade for {}. Another near plane, thickness or setting needs another export: "
                    "the shaders hold their values as constants{}. Written by\n\n    {}\n\n",
                    projection_text(view), what.kept.empty() ? "" : ", but for those that the host sets", what.command);
    text += fmt::format("## Passes, in their order\n"
                        "{}\n"
                        "A barrier belongs between each two dispatches. "
                        "`has_ray()` in the ray set-up says which pixels reflect: "
                        "as it is, all with a surface and a normal. "
                        "Let it ask for your materials, or fill the list of rays yourself instead.\n\n",
                        passes_table(passes, what.language));
    text += depth_text(view);
    text += fmt::format("## Resources\n{}\n{} Names that a shader gives to one resource may differ.\n\n",
                        resources_table(passes, composed), bindings_text(what.language));
    text +=
        fmt::format("## What comes back\n{} The hit point is `origin + t * delta`, in pixels and depth.\n\n", statuses);
    text += fmt::format("## Settings\n{}\n", settings_text(what, "- {} = {}\n"));
    text += constants_text(what, passes);
    text +=
        fmt::format("## Cost\n"
                    "On the frame `{}` a ray takes {:.1f} steps, {:.1f} depth fetches and {:.1f} structure fetches. "
                    "`ssrlab shaders {} --chip navi21` shows instructions and registers.\n\n",
                    cost.frame, cost.steps, cost.depth_fetches, cost.structure_fetches, what.technique.id);
    if (what.language == ExportLanguage::wgsl)
        text +=
            "## Host\n"
            "`run.js` is a host for WebGPU without dependencies: "
            "it makes the resources and pipelines of a frame, runs its passes and reads hits back. "
            "In a page that a server gives out of this folder, "
            "`verifyFolder(await openDevice(), \"\", [\"scene\"], console.log)` runs the proof on the visitor's GPU. "
            "WGSL has no `precise`, so a GPU may round otherwise than `expected/`.\n\n";
    text +=
        "## Proof\n"
        "`frames/` has inputs and `expected/` has the answer of every ray. "
        "`ssrlab export --verify FOLDER` runs these files and compares. "
        "A host of your own reads `frames/NAME.json`: "
        "it lists each resource (its bytes, its file, or the word that fills it), "
        "and each pass with its bindings and dispatches as numbers. "
        "Status and pixel must be equal, and t to the bit.\n\n"
        "The frames give `host_depth` in the convention that the first lines name, not in your engine's convention. "
        "Run the proof before you change `host_depth()`: once it converts, rays must differ here. "
        "To check the conversion, export with `--scene FRAME.exr`, a frame of your engine: "
        "`frames/scene.host_depth.bin` holds what your `host_depth()` has to return at each of its pixels.";
    if (what.language == ExportLanguage::hlsl)
        text += " `--verify` compiles HLSL with glslang and runs it by Vulkan. "
                "Neither DXC nor D3D12 has seen these files.";
    text += "\n\n";
    return text + "## Licence\n"
                  "MIT, copyright 2026 the ssrlab authors. "
                  "A technique from another folder is under its author's licence.\n";
}

} // namespace ssrlab
