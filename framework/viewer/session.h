// What the viewer shows and what was measured of it, without a window: settings in, pictures and numbers out.
#pragma once

#include "compare/display.h"
#include "compare/measures.h"
#include "harness/choice.h"
#include "harness/experiment.h"
#include "sources/answer_rays.h"
#include "truth/scene_bvh.h"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace ssrlab {

inline constexpr std::array<std::string_view, 6> shown_names = {"picture", "agreement", "causes",
                                                                "sources", "fetches",   "truth"};

/// What has to be made again.
struct Stale {
    bool view = true, trace = true, truth = true, measures = true, answers = true, true_picture = true, shown = true;
};

struct Session {
    PictureOptions            picture;  // as the command line names it
    std::vector<Setting>      settings; // of the stage's catalogue
    Stage                     stage;
    std::unique_ptr<SceneBvh> bvh; // empty: a frame of another renderer

    // Panel, keys and script change these and say what is stale.
    const Technique* technique = nullptr;
    Choice           choice;
    Camera           camera;
    bool             camera_moved = false;
    std::string      show         = "picture";
    std::string      sources;         // as `ssrlab render --sources` takes them; empty: the frame alone
    double           split       = 0; // the right part of the picture that shows the true reflection, as a share
    double           exposure_ev = 0;
    Stale            stale;

    // What work() made of them.
    FramePtr                  frame;
    std::vector<FrameTimes>   times; // of this frame, one after another
    GBufferImage              gbuffer;
    Image                     shaded, true_picture;
    TraceImage                counted;
    std::optional<SceneTruth> scene_truth;
    std::optional<TraceImage> screen_truth; // of a frame of another renderer
    MeasureValues             measures;
    std::vector<ListedSource> listed; // of `sources`; in the place of `auto`, what it chose
    AnsweredRays              answered;
    Image                     shown;       // linear display light
    int                       version = 0; // of `shown`
    std::string               problem;     // why the settings cannot be shown; empty: they can
};

std::unique_ptr<Session> open_session(const CommonOptions& common, const PictureOptions& picture);

/// Sets a value by its name: technique, show, sources, split, exposure, a setting, or a parameter of the technique.
/// Throws SpecError.
void set_value(Session& session, const std::string& name, const std::string& text);
/// Makes everything stale after a change of the camera.
void camera_changed(Session& session);
/// Lets orbits turn about the surface in the middle of the picture.
void aim(Session& session);
bool camera_is_free(const Session& session);

/// Returns whether the session asks sources and has their answers for this frame.
bool has_answers(const Session& session);

/// Makes the next stale part anew, or times another frame. Returns false if nothing was left to do.
bool work(Session& session);

/// A measured number and what it is, for people and scripts.
struct Reading {
    std::string name, value;
};
std::vector<Reading> readings(const Session& session);

/// What the ray of a pixel did, and what it should have done.
struct PixelRay {
    std::string               text;
    std::optional<glm::dvec2> found_px, true_px;
    std::string               command; // ssrlab ray …; empty where the camera is no view of the scene
};
PixelRay ray_at(const Session& session, glm::ivec2 pixel);

} // namespace ssrlab
