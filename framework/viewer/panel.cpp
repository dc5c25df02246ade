#include "viewer/panel.h"

#include "core/error.h"
#include "harness/experiment.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ssrlab {
namespace {

constexpr double longest_slider = 1e6; // ranges beyond it are typed
constexpr double shortest_log   = 100; // wider ranges are logarithmic

void tip(const std::string& text)
{
    if (!ImGui::IsItemHovered()) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(360);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

/// A list to choose from; the entry that was chosen, or nothing.
template <typename NameOf>
std::optional<size_t> combo(const char* label, const std::string& current, size_t count, const NameOf& name_of)
{
    std::optional<size_t> chosen;
    if (!ImGui::BeginCombo(label, current.c_str())) return chosen;
    for (size_t i = 0; i < count; ++i)
        if (ImGui::Selectable(std::string(name_of(i)).c_str(), current == name_of(i))) chosen = i;
    ImGui::EndCombo();
    return chosen;
}

bool integer_widget(const Parameter& parameter, double& value)
{
    int        number = static_cast<int>(value);
    const int  low = static_cast<int>(parameter.min), high = static_cast<int>(parameter.max);
    const int  flags   = ImGuiSliderFlags_AlwaysClamp | (high - low > shortest_log ? ImGuiSliderFlags_Logarithmic : 0);
    const bool changed = ImGui::SliderInt(parameter.name.c_str(), &number, low, high, "%d", flags);
    value              = number;
    return changed;
}

bool real_widget(const Parameter& parameter, double& value)
{
    if (parameter.max >= longest_slider)
        return ImGui::InputDouble(parameter.name.c_str(), &value, 0, 0, "%.6g", ImGuiInputTextFlags_EnterReturnsTrue);
    const double low = parameter.min, high = parameter.max;
    return ImGui::SliderScalar(parameter.name.c_str(), ImGuiDataType_Double, &value, &low, &high, "%.4g",
                               ImGuiSliderFlags_AlwaysClamp);
}

/// A slab's thickness has no upper end that a slider could have: a drag by a hundredth of itself.
bool drag_widget(const Parameter& parameter, double& value)
{
    const double low = parameter.min, high = parameter.max;
    const auto   speed = static_cast<float>(std::max(std::abs(value), 0.01) / 100);
    return ImGui::DragScalar(parameter.name.c_str(), ImGuiDataType_Double, &value, speed, &low, &high, "%.4g m",
                             ImGuiSliderFlags_AlwaysClamp);
}

void set_or_say(Session& session, const std::string& name, const std::string& text)
{
    try {
        set_value(session, name, text);
    } catch (const SpecError& error) {
        session.problem = error.what();
    }
}

/// By the parameter's type and range; tells the session what was chosen.
void widget(Session& session, const Parameter& parameter, double value)
{
    bool changed = false;
    switch (parameter.type) {
    case ParameterType::boolean: {
        bool on = value != 0;
        changed = ImGui::Checkbox(parameter.name.c_str(), &on);
        value   = on ? 1 : 0;
        break;
    }
    case ParameterType::choice: {
        const auto chosen = combo(parameter.name.c_str(), parameter.choices[static_cast<size_t>(value)],
                                  parameter.choices.size(), [&](size_t i) { return parameter.choices[i]; });
        changed           = chosen.has_value();
        if (chosen) value = static_cast<double>(*chosen);
        break;
    }
    case ParameterType::integer: changed = integer_widget(parameter, value); break;
    case ParameterType::real:
        changed = parameter.name == "thickness_m" ? drag_widget(parameter, value) : real_widget(parameter, value);
    }
    tip(fmt::format("{}\nDefault: {}", parameter.doc, format_parameter(parameter, parameter.default_value)));
    if (!changed) return;
    set_or_say(session, parameter.name, format_parameter(parameter, value));
}

void technique_widgets(Session& session)
{
    const auto& techniques = session.stage.catalogue.techniques;
    if (const auto chosen =
            combo("technique", session.technique->id, techniques.size(), [&](size_t i) { return techniques[i].id; }))
        set_value(session, "technique", techniques[*chosen].id);
    tip(session.technique->summary);
    for (const Parameter& parameter : session.technique->parameters)
        widget(session, parameter, session.choice.values.at(parameter.name));
}

void setting_widgets(Session& session, std::string_view table)
{
    for (const Setting& setting : session.settings)
        if (setting.table == table) widget(session, setting, setting.get(session.choice.settings));
}

void show_widgets(Session& session)
{
    if (const auto chosen = combo("show", session.show, shown_names.size(), [](size_t i) { return shown_names[i]; }))
        set_value(session, "show", std::string(shown_names[*chosen]));
    tip("The picture, its rays in false colours (docs/how-to/read_the_report.md), or the true reflection");
    std::array<char, 256> sources{};
    session.sources.copy(sources.data(), sources.size() - 1);
    if (ImGui::InputText("sources", sources.data(), sources.size(), ImGuiInputTextFlags_EnterReturnsTrue))
        set_or_say(session, "sources", sources.data());
    tip("Sources of answers, in the order in which they are asked: frame,planar,world (docs/explanation/beyond.md)");
    auto split = static_cast<float>(session.split);
    if (ImGui::SliderFloat("split", &split, 0, 1, "%.2f", ImGuiSliderFlags_AlwaysClamp))
        set_value(session, "split", fmt::format("{}", split));
    tip("The right part of the picture shows the true reflection");
    auto exposure_ev = static_cast<float>(session.exposure_ev);
    if (ImGui::SliderFloat("exposure", &exposure_ev, -8, 8, "%.1f EV", ImGuiSliderFlags_AlwaysClamp))
        set_value(session, "exposure", fmt::format("{}", exposure_ev));
}

void reading_table(const Session& session)
{
    for (const Reading& reading : readings(session)) {
        ImGui::TextUnformatted(reading.name.c_str());
        ImGui::SameLine(150);
        ImGui::TextUnformatted(reading.value.c_str());
    }
}

void ray_text(const std::optional<PixelRay>& ray)
{
    if (!ray) {
        ImGui::TextDisabled("Point at a pixel: its ray is drawn.");
        return;
    }
    ImGui::TextUnformatted(ray->text.c_str());
    if (!ray->command.empty()) ImGui::TextDisabled("C copies its ssrlab ray command.");
}

} // namespace

void draw_panel(Session& session, const std::optional<PixelRay>& ray, float height_px)
{
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({static_cast<float>(panel_width_px), height_px});
    ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove);
    ImGui::PushItemWidth(200);
    technique_widgets(session);
    ImGui::Separator();
    show_widgets(session);
    ImGui::Separator();
    reading_table(session);
    if (!session.problem.empty()) {
        ImGui::PushTextWrapPos(0);
        ImGui::TextColored({1, 0.4F, 0.3F, 1}, "%s", session.problem.c_str());
        ImGui::PopTextWrapPos();
    }
    ImGui::Separator();
    ray_text(ray);
    ImGui::Separator();
    if (ImGui::CollapsingHeader("Hit contract ([trace])", ImGuiTreeNodeFlags_DefaultOpen))
        setting_widgets(session, "trace");
    if (ImGui::CollapsingHeader("Effects ([passes])")) setting_widgets(session, "passes");
    if (camera_is_free(session))
        ImGui::TextDisabled("Drag: orbit. Right drag: look.\nWheel: nearer. W A S D Q E: fly.");
    else
        ImGui::TextDisabled("A frame of another renderer: its camera stays.");
    ImGui::PopItemWidth();
    ImGui::End();
}

} // namespace ssrlab
