#include "viewer/viewer.h"

#include "core/error.h"
#include "viewer/camera_motion.h"
#include "viewer/panel.h"
#include "viewer/script.h"
#include "viewer/session.h"
#include "viewer/window.h"

#include <imgui.h>

#include <algorithm>
#include <cstdio>

namespace ssrlab {
namespace {

constexpr double idle_wait_s         = 0.1;
constexpr double degrees_per_px      = 0.3;
constexpr double target_widths_per_s = 0.5; // flying: of the target's distance
constexpr int    least_height_px     = 820;

/// Where the picture stands in the window.
struct Placed {
    ImVec2 corner;
    float  scale = 1;

    ImVec2 at(glm::dvec2 px) const
    {
        return {corner.x + scale * static_cast<float>(px.x), corner.y + scale * static_cast<float>(px.y)};
    }
};

struct Viewer {
    Session&                  session;
    Window&                   window;
    std::optional<glm::ivec2> cursor;       // the pixel whose ray is shown
    int                       uploaded = 0; // Session::version
};

Placed draw_picture(Viewer& viewer)
{
    Session& session = viewer.session;
    if (viewer.uploaded != session.version) viewer.window.set_picture(session.shown);
    viewer.uploaded      = session.version;
    const ImVec2    room = ImGui::GetIO().DisplaySize;
    const glm::vec2 size(session.stage.view.size_px);
    const float     left = static_cast<float>(panel_width_px);
    const Placed    placed{{left, 0}, std::max(0.05F, std::min((room.x - left) / size.x, room.y / size.y))};
    ImDrawList*     list = ImGui::GetBackgroundDrawList();
    if (session.version > 0) list->AddImage(viewer.window.picture(), placed.corner, placed.at(size));
    if (session.split > 0) {
        const double x = (1 - session.split) * size.x;
        list->AddLine(placed.at({x, 0}), placed.at({x, size.y}), IM_COL32(255, 255, 255, 160));
    }
    return placed;
}

void draw_ray(const Placed& placed, glm::ivec2 pixel, const PixelRay& ray)
{
    ImDrawList*  list = ImGui::GetBackgroundDrawList();
    const ImVec2 from = placed.at(glm::dvec2(pixel) + 0.5);
    // White on black, so that they stand out on any picture; the true reflection below the one that was found.
    const auto line = [&](glm::dvec2 to_px, ImU32 colour, float thickness) {
        list->AddLine(from, placed.at(to_px), IM_COL32(0, 0, 0, 255), thickness + 2);
        list->AddLine(from, placed.at(to_px), colour, thickness);
        list->AddCircleFilled(placed.at(to_px), thickness + 3, colour);
    };
    if (ray.true_px) line(*ray.true_px, IM_COL32(0, 158, 115, 255), 7);
    if (ray.found_px) line(*ray.found_px, IM_COL32(255, 255, 255, 255), 1.5F);
    list->AddCircle(from, 5, IM_COL32(0, 0, 0, 255), 0, 3);
    list->AddCircle(from, 5, IM_COL32(255, 255, 255, 255), 0, 1.5F);
}

void mouse(Viewer& viewer, const Placed& placed)
{
    Session& session = viewer.session;
    ImGuiIO& io      = ImGui::GetIO();
    viewer.cursor.reset();
    if (io.WantCaptureMouse) return;
    const glm::ivec2 pixel(
        glm::floor(glm::vec2(io.MousePos.x - placed.corner.x, io.MousePos.y - placed.corner.y) / placed.scale));
    const glm::ivec2 size_px = session.stage.view.size_px;
    if (pixel.x >= 0 && pixel.y >= 0 && pixel.x < size_px.x && pixel.y < size_px.y) viewer.cursor = pixel;
    if (!camera_is_free(session)) return;
    const double right_deg = -degrees_per_px * io.MouseDelta.x, up_deg = degrees_per_px * io.MouseDelta.y;
    const bool   moved = io.MouseDelta.x != 0 || io.MouseDelta.y != 0;
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Left) && !session.stale.truth) aim(session);
    if (moved && ImGui::IsMouseDown(ImGuiMouseButton_Left))
        orbit(session.camera, right_deg, up_deg), camera_changed(session);
    if (moved && ImGui::IsMouseDown(ImGuiMouseButton_Right))
        look(session.camera, -right_deg, -up_deg), camera_changed(session);
    if (io.MouseWheel != 0) approach(session.camera, std::pow(0.9, io.MouseWheel)), camera_changed(session);
}

void keys(Session& session)
{
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantCaptureKeyboard || io.KeyCtrl || !camera_is_free(session)) return;
    const auto down = [&](char plus, char minus) { // GLFW names letters by their capitals
        return double(ImGui::IsKeyDown(plus)) - double(ImGui::IsKeyDown(minus));
    };
    const glm::dvec3 way(down('D', 'A'), down('E', 'Q'), down('W', 'S'));
    if (way == glm::dvec3(0)) return;
    const double m = target_widths_per_s * std::min<double>(io.DeltaTime, 0.2) *
                     glm::distance(session.camera.position_ws, session.camera.target_ws);
    fly(session.camera, m * way.x, m * way.y, m * way.z);
    camera_changed(session);
}

void move_camera(Session& session, const ScriptCommand& command)
{
    if (!camera_is_free(session))
        throw_spec_error("{}: the camera of a frame of another renderer stays", command.place);
    const auto number = [&](size_t i) { return number_of(command, i); };
    if (command.word == "orbit") orbit(session.camera, number(0), number(1));
    if (command.word == "look") look(session.camera, number(0), number(1));
    if (command.word == "fly") fly(session.camera, number(0), number(1), number(2));
    if (command.word == "approach") approach(session.camera, number(0));
    camera_changed(session);
}

void move_cursor(Viewer& viewer, const ScriptCommand& command)
{
    const glm::dvec2 at(number_of(command, 0), number_of(command, 1));
    const glm::ivec2 size_px = viewer.session.stage.view.size_px;
    if (at != glm::floor(at) || at.x < 0 || at.y < 0 || at.x >= size_px.x || at.y >= size_px.y)
        throw_spec_error("{}: expected a pixel of the image of {}x{}, got {} {}", command.place, size_px.x, size_px.y,
                         command.arguments[0], command.arguments[1]);
    viewer.cursor = glm::ivec2(at);
}

/// After a frame that shows everything before the command.
void obey(Viewer& viewer, const ScriptCommand& command)
{
    if (command.word == "set") {
        const std::string& pair   = command.arguments[0];
        const auto         equals = pair.find('=');
        if (equals == std::string::npos) throw_spec_error("{}: expected name=value, got '{}'", command.place, pair);
        try {
            set_value(viewer.session, pair.substr(0, equals), pair.substr(equals + 1));
        } catch (const SpecError& error) {
            throw_spec_error("{}: {}", command.place, error.what());
        }
    } else if (command.word == "cursor") {
        move_cursor(viewer, command);
    } else if (command.word == "screenshot") {
        viewer.window.screenshot(command.arguments[0]);
    } else if (command.word == "print") {
        for (const Reading& reading : readings(viewer.session))
            std::puts(fmt::format("{}: {}", reading.name, reading.value).c_str());
        if (viewer.cursor) std::puts(ray_at(viewer.session, *viewer.cursor).text.c_str());
    } else {
        move_camera(viewer.session, command);
    }
}

/// Picture, panel and ray; returns where the picture stands.
Placed draw_frame(Viewer& viewer)
{
    const Placed            placed = draw_picture(viewer);
    std::optional<PixelRay> ray;
    if (viewer.cursor) ray = ray_at(viewer.session, *viewer.cursor);
    if (ray) draw_ray(placed, *viewer.cursor, *ray);
    if (ray && !ray->command.empty() && !ImGui::GetIO().WantCaptureKeyboard && ImGui::IsKeyPressed('C', false))
        ImGui::SetClipboardText(ray->command.c_str());
    draw_panel(viewer.session, ray, ImGui::GetIO().DisplaySize.y);
    viewer.window.draw();
    return placed;
}

void run_script(Viewer& viewer, const std::vector<ScriptCommand>& commands)
{
    for (const ScriptCommand& command : commands) {
        while (work(viewer.session)) {}
        if (!viewer.session.problem.empty()) throw_spec_error("{}: {}", command.place, viewer.session.problem);
        viewer.window.begin_frame(0);
        draw_frame(viewer);
        obey(viewer, command);
        viewer.window.present();
    }
}

void run_by_hand(Viewer& viewer)
{
    bool busy = true;
    while (!viewer.window.is_closed()) {
        viewer.window.begin_frame(busy ? 0 : idle_wait_s);
        const Placed placed = draw_frame(viewer);
        viewer.window.present();
        mouse(viewer, placed);
        keys(viewer.session);
        busy = work(viewer.session);
    }
}

} // namespace

int view_scene(const CommonOptions& common, const ViewOptions& options)
{
    const std::vector<ScriptCommand> commands =
        options.script.empty() ? std::vector<ScriptCommand>() : read_script(options.script);
    const auto       session = open_session(common, options.picture);
    const glm::ivec2 size_px = session->stage.view.size_px;
    Window           window(("ssrlab view " + options.picture.scene).c_str(),
                            {panel_width_px + size_px.x, std::max(size_px.y, least_height_px)});
    Viewer           viewer{*session, window, {}};
    if (options.script.empty())
        run_by_hand(viewer);
    else
        run_script(viewer, commands);
    return report_messages(session->stage);
}

} // namespace ssrlab
