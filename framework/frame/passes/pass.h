// A pass: one step of a frame, run only if the frame needs it. Each has a file of its own in this folder.
#pragma once

#include "frame/passes/choices.h"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace ssrlab {

struct Commands;
struct FrameFacts;
struct FrameStatistics;
struct FrameInputs;
struct Gpu;
struct Pass;

/// Whether a frame needs a pass, and the reason with the number that decided.
struct PassDecision {
    enum Verdict : uint8_t { off, not_needed, needed };
    Verdict     verdict = needed;
    std::string reason;
};

/// Records a pass's commands.
using RecordFunction = std::function<void(const Commands&)>;

/// The inputs of passes, and what passes hand to each other.
enum class Resource : uint8_t {
    gbuffer,      // depth, normals and materials
    light,        // lit colours of the G-buffer
    objects,      // which object each pixel shows, how it moved, and the plane of its depth
    layers,       // the layers behind the G-buffer
    solids,       // where the solids end that the G-buffer shows
    surroundings, // lights, shadow maps and environment of the scene
    tiles,        // that reflect
    rays,
    structures,
    hits,
    answers,     // light of rays that the frame does not answer itself
    reprojected, // where each reflection was in the frame before
    small_colour,
    cones,
    reflection,
    filtered, // the target of a filter, or an earlier reflection
    block_pixel,
    lobe_rays, // light and end of each ray of rough pixels
    history,   // what the frame before left
    kept,      // what this frame leaves for the next
    shaded,
};
std::string_view name_of(Resource resource);

/// What prepare() gets: the frame's inputs, of which the pass may use what it declares.
struct PassContext {
    const FrameInputs& frame;
    const Pass&        pass;
    std::string        id; // of the pass, or of the structure that it builds
};

/// A step of a frame. Skipping it when it is not needed changes no bit of the image.
struct Pass {
    std::string              id, summary;
    std::vector<std::string> cite = {};
    /// Using anything else throws std::logic_error.
    std::vector<Resource>  reads, writes;
    std::vector<Parameter> parameters = {};
    PassDecision (*decide)(const FrameFacts&, const FrameStatistics&, const ParameterValues&);
    /// Compiles the pass and returns its record function, which refers to the frame's inputs: they must outlive it.
    RecordFunction (*prepare)(Gpu&, const PassContext&) = nullptr;
    bool beyond_shading                                 = false; // off with pass_set = shading
    bool per_structure = false; // runs once per structure of the technique, under its id
    /// Of a pass over the whole image: what its shaders read, by name, of reflecting pixels alone.
    std::vector<std::string> read_of_reflectors = {};
};

Pass layers_pass();
Pass solid_backs_pass();
Pass classification_pass();
Pass rays_pass();
Pass structures_pass();
Pass trace_pass();
Pass hidden_layer_pass();
Pass missed_rays_pass();
Pass reprojection_pass();
Pass colour_downsampling_pass();
Pass cone_pyramid_pass();
Pass hit_colour_pass();
Pass bounces_pass();
Pass ray_blur_pass();
Pass upsampling_pass();
Pass ray_reuse_pass();
Pass filter_3x3_pass();
Pass blur_pass();
Pass environment_pass();
Pass history_pass();
Pass composite_pass();
Pass picture_history_pass();

/// Returns all passes in the order of a frame.
std::span<const Pass> all_passes();
/// Returns the parameters of the plan itself: what may run at all.
std::vector<Parameter> plan_parameters();
/// Returns plan_parameters(), then the parameters of all passes. Names are unique.
std::span<const Parameter> pass_parameters();
ParameterValues            default_pass_values();

} // namespace ssrlab
