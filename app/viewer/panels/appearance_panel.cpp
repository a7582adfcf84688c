#include "app/viewer/panels/appearance_panel.h"

#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "app/viewer/panels/toolkit/widgets.h"

namespace reljef::app {
namespace {

constexpr double min_altitude = 1.0; // degrees, of the slider
constexpr double max_altitude = 90.0;
constexpr double full_circle = 360.0;
constexpr double min_factor = 0.1; // of the slider; the option takes any
constexpr double max_factor = 20.0;
constexpr std::array sample_counts{1, 2, 4, 8, 16};

bool draw_slider(const char* name, double& value, double low, double high, const char* format,
                 ImGuiSliderFlags flags = 0) {
    row(name, fmt::format(fmt::runtime(format), value));
    ImGui::SetNextItemWidth(-1.0F);
    ImGui::PushID(name);
    const bool is_moved = ImGui::SliderScalar("##slider", ImGuiDataType_Double, &value, &low, &high,
                                              "", flags | ImGuiSliderFlags_AlwaysClamp);
    ImGui::PopID();
    return is_moved;
}

PanelActions draw_sun(const AppearanceContent& appearance) {
    SetSun sun{std::fmod(appearance.light.azimuth + full_circle, full_circle),
               appearance.light.altitude};
    const bool is_turned =
        draw_slider("Azimuth, from north clockwise", sun.azimuth, 0.0, full_circle, "{:.0f}\u00b0");
    const bool is_raised =
        draw_slider("Altitude", sun.altitude, min_altitude, max_altitude, "{:.0f}\u00b0");
    if (!(is_turned || is_raised)) {
        return {};
    }
    if (is_turned) { // as shown
        sun.azimuth = std::round(sun.azimuth);
    } else {
        sun.altitude = std::max(std::round(sun.altitude), min_altitude);
    }
    return {sun};
}

PanelActions draw_exaggeration(const AppearanceContent& appearance) {
    double factor = appearance.exaggeration;
    ImGui::BeginDisabled(!appearance.fixed_exaggeration.empty());
    const bool is_moved = draw_slider("Vertical exaggeration", factor, min_factor, max_factor,
                                      "{:.2f} \u00d7", ImGuiSliderFlags_Logarithmic);
    ImGui::EndDisabled();
    tip(appearance.fixed_exaggeration);
    const bool is_reset = factor != 1.0 && ImGui::SmallButton("true heights");
    if (is_reset) {
        return {SetExaggeration{1.0}};
    }
    constexpr double shown_parts = 100.0; // of 1
    return is_moved ? PanelActions{SetExaggeration{std::round(factor * shown_parts) / shown_parts}}
                    : PanelActions();
}

PanelActions draw_samples(const AppearanceContent& appearance) {
    const auto name_of = [](std::optional<int> samples) {
        return samples ? fmt::format("{} per pixel", *samples) : std::string("automatic");
    };
    PanelActions actions;
    muted_text("Samples");
    ImGui::SetNextItemWidth(-1.0F);
    if (ImGui::BeginCombo("##samples", name_of(appearance.samples).c_str())) {
        if (ImGui::Selectable("automatic", !appearance.samples)) {
            actions.emplace_back(SetSamples{});
        }
        for (const int count : sample_counts) {
            if (ImGui::Selectable(name_of(count).c_str(), appearance.samples == count)) {
                actions.emplace_back(SetSamples{count});
            }
        }
        ImGui::EndCombo();
    }
    tip("Automatic: 4 for triangles, else 1; fewer while a slow view moves");
    return actions;
}

// A box that does what a key does.
PanelActions draw_switch(const char* label, bool is_on, Key key) {
    return tick(label, is_on) ? PanelActions{PressKey{key}} : PanelActions();
}

} // namespace

PanelActions draw_appearance(const PanelContent& content, const Fonts& fonts) {
    const AppearanceContent& appearance = content.appearance;
    const FontScope small(fonts.small);
    PanelActions actions;
    section(fonts.heading, "Sun");
    actions += draw_sun(appearance);
    section(fonts.heading, "Picture");
    actions += draw_exaggeration(appearance);
    actions += draw_samples(appearance);
    actions += draw_switch("Wireframe  (F)", content.technique.wireframe, Key::f);
    section(fonts.heading, "View");
    actions += draw_switch("Map from above  (O)", appearance.shows_map, Key::o);
    actions += draw_switch("Fly along the path  (P)", appearance.plays_path, Key::p);
    actions += draw_switch("Keep the height above ground  (G)", appearance.follows_ground, Key::g);
    if (wide_button("Back to the first view  (R)")) {
        actions.emplace_back(PressKey{Key::r});
    }
    return actions;
}

} // namespace reljef::app
