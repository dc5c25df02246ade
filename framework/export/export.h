// Takes a technique out of the lab: a folder with one shader for each pass, frames with right answers, and their proof.
//
//     FOLDER/README.md            what the host provides, what comes back, how to dispatch
//     FOLDER/1_depth.comp …       the passes, in the order in which they run
//     FOLDER/frames/NAME.json     buffers, bindings and dispatches of one frame as numbers, with NAME.*.bin beside it
//     FOLDER/expected/NAME.bin    what each of its rays found inside the lab
#pragma once

#include "trace/lab.h"

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace ssrlab {

enum class ExportLanguage { glsl, hlsl, msl, essl, wgsl };

struct Export {
    const Catalogue&                                 catalogue;
    const Technique&                                 technique;
    const ParameterValues&                           values;
    const TraceSettings&                             settings;
    ExportLanguage                                   language = ExportLanguage::glsl;
    std::string                                      command;     // that repeats it
    std::vector<std::pair<std::string, std::string>> chosen = {}; // settings and parameters with their values
    std::set<std::string> kept = {}; // numbers of the technique that stay specialization constants
};

/// A frame of the proof. All frames of an export have the same projection, near and far plane: those of the shaders.
struct ExportFrame {
    std::string           name, what;
    GBufferImage          gbuffer;
    std::vector<RayInput> rays =
        {}; // empty: the mirror ray of each pixel that reflects, which the ray set-up makes, too
};

/// What SPIR-V was translated to. Hard cases share most of their shaders, and a translator takes longer to start than
/// to translate one.
using Translations = std::map<std::pair<ExportLanguage, std::vector<uint32_t>>, std::string>;

/// The ending of the language's files.
const char* file_ending(ExportLanguage language);

/// Writes the folder, which must be missing or empty. Throws SpecError for settings that an export cannot hold and for
/// shaders that do not compile, Failure for a folder that cannot be written.
void write_export(Gpu& gpu, const Export& what, std::span<const ExportFrame> frames, Translations& translations,
                  const std::filesystem::path& folder);

/// A ray that is set up, or that ended, otherwise than in the lab.
struct AnswerDifference {
    bool        is_set_up = false;
    size_t      ray       = 0; // of those traced, by its place in the frame's list
    glm::ivec2  pixel{0};
    std::string values = {}, expected = {}, answered = {}; // the names of those that differ, and what they are
    double      apart_px = 0;     // between the ends of both; infinite where they are not comparable
    bool is_near_tie     = false; // as rounding moves it: by less than 0.05 px, within a pixel or to one that touches
};

/// How the exported shaders answered one frame.
struct FrameVerdict {
    std::string frame;
    size_t      rays = 0, set_up = 0;               // rays traced, and rays of the ray set-up where the frame has it
    std::vector<AnswerDifference> differences = {}; // by status, by pixel, or by any bit of t or of the ray
};

/// Runs the folder's shaders on its frames, and nothing of the lab. Throws SpecError for a folder that is no export, or
/// whose shaders do not compile.
std::vector<FrameVerdict> verify_export(Gpu& gpu, const std::filesystem::path& folder);

struct WgslVerdicts {
    std::vector<FrameVerdict> frames;
    std::string               device; // as the browser names it
};
bool is_wgsl_export(const std::filesystem::path& folder);
/// The same for exports to WGSL, by WebGPU in Chromium without a window, on its software device. Returns the frames of
/// all folders, in their order. Throws Failure if the browser or node is missing, or does not run the shaders.
WgslVerdicts verify_wgsl_exports(std::span<const std::filesystem::path> folders);

} // namespace ssrlab
