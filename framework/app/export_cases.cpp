#include "app/cases.h"
#include "check/hard_case.h"
#include "check/hit_files.h"
#include "check/run_check.h"
#include "compare/image_io.h"
#include "core/files.h"
#include "core/pixel_index.h"
#include "core/plane_gradient.h"
#include "harness/experiment.h"
#include "scene/load_frame.h"
#include "truth/screen_ray.h"
#include "truth/screen_truth.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;
using Json   = nlohmann::ordered_json;

/// Every setting of [trace] as -p takes it. Throws SpecError for one that the command line refuses.
Json settings_of(const Catalogue& catalogue, const TraceSettings& trace)
{
    FrameSettings frame;
    frame.trace = trace;
    Json json   = Json::object();
    for (const Setting& setting : all_settings(catalogue)) {
        if (setting.table != "trace") continue;
        const std::string text = format_parameter(setting, setting.get(frame));
        parse_parameter(setting, text, setting.name);
        json[setting.name] = text;
    }
    return json;
}

/// Without what only the drawn G-buffer has; planes follow from the normals, as in any frame file.
GBufferImage complete(GBufferImage gbuffer)
{
    complete_gradients(gbuffer);
    gbuffer.solid_back.resize(gbuffer.depth.size());
    return gbuffer;
}

/// The closed form of a case against the answers that are written.
void require_closed_form(const HardCase& hard_case, const Setup& setup, const TraceImage& truth)
{
    if (!hard_case.expected) return;
    for (size_t i = 0; i < truth.status.size(); ++i) {
        if (truth.status[i] == TraceStatus::not_traced) continue;
        const glm::ivec2 pixel = pixel_at(i, truth.size_px);
        const ScreenRay  ray   = make_screen_ray(setup.gbuffer, pixel, setup.settings);
        const auto       right =
            hard_case.expected(setup, {ray.origin_px_depth, ray.delta_px_depth, ray.length_m, ray.end_status, pixel});
        if (!right || !right->status) continue;
        if (truth.status[i] != *right->status ||
            (has_place(truth.status[i]) && truth.hit_pixel[i] != right->pixel.value_or(truth.hit_pixel[i])))
            throw_failure("{}: ray of ({}, {}): the closed form and the contract disagree", hard_case.name, pixel.x,
                          pixel.y);
    }
}

/// The folder as it grows.
struct CasesFolder {
    const Catalogue& catalogue;
    fs::path         path;
    Json             frames = Json::array(), left_out = Json::array();
};

Json camera_of(const View& view)
{
    Json json{{"projection", view.projection == Projection::perspective ? "perspective" : "orthographic"},
              {"focal_px", {view.focal_px.x, view.focal_px.y}},
              {"centre_px", {view.centre_px.x, view.centre_px.y}},
              {"near_m", view.near_m}};
    if (view.projection == Projection::orthographic) json["far_m"] = view.far_m;
    return json;
}

/// Writes the frame's right answers and its entry. The answers are those of the file, as an engine reads it.
void add_entry(CasesFolder& folder, const std::string& name, const std::string& breaks, const std::string& answer,
               const Setup& setup, const std::string& depth, const HardCase* hard_case)
{
    const fs::path frame = fs::path("frames") / (name + ".exr"), expected = fs::path("expected") / (name + ".exr");
    const Json     settings = settings_of(folder.catalogue, setup.settings);
    Setup          loaded   = setup;
    loaded.gbuffer          = complete(load_frame(folder.path / frame).gbuffer);
    const TraceImage truth  = screen_truth(loaded.gbuffer, setup.settings);
    if (hard_case != nullptr) require_closed_form(*hard_case, loaded, truth);
    const size_t rays =
        truth.status.size() - static_cast<size_t>(std::ranges::count(truth.status, TraceStatus::not_traced));
    if (rays == 0) throw_spec_error("no pixel reflects");
    write_image(folder.path / expected, hits_image(truth));
    folder.frames.push_back({{"name", name},
                             {"frame", frame.string()},
                             {"expected", expected.string()},
                             {"breaks", breaks},
                             {"answer", answer},
                             {"size_px", {truth.size_px.x, truth.size_px.y}},
                             {"camera", camera_of(loaded.gbuffer.view)},
                             {"depth", depth},
                             {"settings", settings},
                             {"rays", rays},
                             {"hits", std::ranges::count(truth.status, TraceStatus::hit)}});
}

constexpr const char* own_depth = "reversed, infinite far plane: near_m / distance";
constexpr const char* own_flat  = "reversed: (far_m - distance) / (far_m - near_m)";

/// Why the setup is no case for a renderer; empty if it is one.
std::string without_file(const HardCase& hard_case, const Setup& setup)
{
    if (!setup.rays.empty()) return "its rays are listed, and are no mirror rays of a frame";
    if (hard_case.adjust) return "about a technique's parameters";
    return setup.settings.layers > 1 ? "needs more than the first layer" : "";
}

void add_case(CasesFolder& folder, const HardCase& hard_case)
{
    const std::vector<Setup> setups = hard_case.setups();
    for (size_t i = 0; i < setups.size(); ++i) {
        const Setup&      setup = setups[i];
        const std::string name  = setups.size() == 1 ? hard_case.name : fmt::format("{}_{}", hard_case.name, i);
        const fs::path    file  = folder.path / "frames" / (name + ".exr");
        std::string       why   = without_file(hard_case, setup);
        if (why.empty()) try {
                write_image(file, frame_image(complete(setup.gbuffer)));
                const bool flat = setup.gbuffer.view.projection == Projection::orthographic;
                add_entry(folder, name, hard_case.breaks, hard_case.answer, setup, flat ? own_flat : own_depth,
                          &hard_case);
                if (!setup.label.empty()) folder.frames.back()["what"] = setup.label;
                if (hard_case.in_order && i > 0)
                    folder.frames.back()["after"] = fmt::format("{}_{}", hard_case.name, i - 1);
            } catch (const SpecError& error) { // NaN, infinity and the like
                why = error.what();
                fs::remove(file);
            }
        if (!why.empty()) folder.left_out.push_back({{"name", name}, {"what", setup.label}, {"why", why}});
    }
}

/// A frame as an engine stores it: depth of its own kind, and a file beside it that says so.
struct StoredDepth {
    std::string                              name, what, toml; // of [depth]
    double                                   far_m = 0;        // of device depth; 0: none
    std::function<double(double distance_m)> of;
};

std::vector<StoredDepth> stored_depths(double near_m, double far_m)
{
    const auto reversed = [=](double distance) { return near_m * (far_m - distance) / (distance * (far_m - near_m)); };
    const auto coded    = [](double value) { return std::round(value * 65535) / 65535; };
    return {{"depth_reversed", "reversed device depth with a far plane", "kind = \"reversed\"", far_m, reversed},
            {"depth_standard", "standard device depth", "kind = \"standard\"", far_m,
             [=](double distance) { return 1 - reversed(distance); }},
            {"depth_standard_16_bits", "standard device depth of 16 bits", "kind = \"standard\"", far_m,
             [=](double distance) { return coded(1 - reversed(distance)); }},
            {"depth_reversed_16_bits", "reversed device depth of 16 bits", "kind = \"reversed\"", far_m,
             [=](double distance) { return coded(reversed(distance)); }},
            {"depth_distance", "distance along the view axis in centimetres",
             "kind = \"distance\"\nunit_m = 0.01\nbackground = 0", 0, [](double distance) { return 100 * distance; }}};
}

/// The same frame under several conventions of depth.
void add_conventions(CasesFolder& folder)
{
    Setup              setup = find_case("contact_points").setups().front();
    const View&        view  = setup.gbuffer.view;
    constexpr double   far_m = 200;
    const GBufferImage own   = complete(setup.gbuffer);
    for (const StoredDepth& stored : stored_depths(view.near_m, far_m)) {
        Image image{
            view.size_px, {"depth", "normal_vs.x", "normal_vs.y", "normal_vs.z", "roughness", "metallic"}, {}, {}};
        const double background = stored.toml.find("standard") != std::string::npos ? 1 : 0;
        for (size_t i = 0; i < own.depth.size(); ++i) {
            const bool   sky   = !(own.depth[i] > 0) || depth_to_distance(view, double(own.depth[i])) > 0.9 * far_m;
            const double depth = sky ? background : stored.of(depth_to_distance(view, double(own.depth[i])));
            for (const float value : {static_cast<float>(depth), own.normal_vs[i].x, own.normal_vs[i].y,
                                      own.normal_vs[i].z, 0.0F, own.metallic[i]})
                image.values.push_back(value);
        }
        const fs::path file = folder.path / "frames" / (stored.name + ".exr");
        write_image(file, image);
        const std::string camera = fmt::format("[camera]\nfov_y_deg = 90\nnear_m = {}\n{}", view.near_m,
                                               stored.far_m > 0 ? fmt::format("far_m = {}\n", stored.far_m) : "");
        write_file_atomically(file.string() + ".toml",
                              fmt::format("{}\n[depth]\n{}\n\n[normals]\nspace = \"view\"\n", camera, stored.toml));
        add_entry(folder, stored.name,
                  "reversed and standard depth, or two units, are mixed up: near is far, and every step is wrong",
                  "The screen truth of the depth that the file's convention stands for.", setup, stored.what, nullptr);
    }
}

} // namespace

int export_cases(const CommonOptions& common, const std::string& folder)
{
    if (fs::exists(folder) && !(fs::is_directory(folder) && fs::is_empty(folder)))
        throw_spec_error("{}: expected a new or empty folder", folder);
    const Catalogue catalogue = load_catalogue(common.technique_dirs);
    CasesFolder     written{catalogue, folder, Json::array(), Json::array()};
    for (const char* part : {"frames", "expected"}) fs::create_directories(written.path / part);
    for (const CaseFamily& family : hard_cases())
        for (const HardCase& hard_case : family.cases) add_case(written, hard_case);
    add_conventions(written);
    const Json manifest{
        {"what", "hard cases of ssrlab: the mirror ray of each pixel that reflects, and its right answer"},
        {"frames", written.frames},
        {"left_out", written.left_out}};
    write_file_atomically(written.path / "manifest.json", manifest.dump(1) + "\n");
    std::puts(fmt::format("{}: {} frames; {} of the catalogue are left out, manifest.json says why", folder,
                          written.frames.size(), written.left_out.size())
                  .c_str());
    return 0;
}

} // namespace ssrlab
