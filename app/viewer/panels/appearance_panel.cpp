#include "app/viewer/panels/appearance_panel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "app/viewer/panels/toolkit/widgets.h"
#include "engine/scene/graph/daylight.h"

namespace reljef::app {
namespace {

constexpr double max_altitude = 90.0; // degrees
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
        draw_slider("Altitude", sun.altitude, lowest_sun, max_altitude, "{:.0f}\u00b0");
    tip("Below 0\u00b0 the sun has set: twilight, down to -18\u00b0");
    if (!(is_turned || is_raised)) {
        return {};
    }
    if (is_turned) { // as shown
        sun.azimuth = std::round(sun.azimuth);
    } else {
        sun.altitude = std::round(sun.altitude);
    }
    return {sun};
}

PanelActions draw_air(const AppearanceContent& appearance) {
    constexpr double nearest = 1e3; // metres, of the slider
    constexpr double farthest = 1e6;
    constexpr double usual = 1e5;
    constexpr double kilometre = 1e3;
    PanelActions actions;
    double turbidity = appearance.turbidity;
    if (draw_slider("Turbidity of the air", turbidity, scene::min_turbidity, scene::max_turbidity,
                    "{:.1f}")) {
        actions.emplace_back(SetTurbidity{std::round(10.0 * turbidity) / 10.0});
    }
    bool is_hazy = appearance.visibility.value_or(0.0) > 0.0;
    if (appearance.visibility && ImGui::Checkbox("Haze", &is_hazy)) {
        actions.emplace_back(SetVisibility{is_hazy ? usual : 0.0});
    }
    if (appearance.visibility.value_or(0.0) > 0.0) {
        double visibility = *appearance.visibility / kilometre;
        if (draw_slider("Visibility, km", visibility, nearest / kilometre, farthest / kilometre,
                        "{:.0f}", ImGuiSliderFlags_Logarithmic)) {
            actions.emplace_back(SetVisibility{kilometre * visibility});
        }
    }
    return actions;
}

PanelActions draw_grain(const AppearanceContent& appearance) {
    double strength = appearance.grain;
    const bool is_moved =
        draw_slider("Grain of near ground", strength, 0.0, scene::max_grain, "{:.2f}");
    tip("Fine structure that the data do not have. Hits and errors are without it.");
    constexpr double shown_parts = 100.0; // of 1
    return is_moved ? PanelActions{SetGrain{std::round(strength * shown_parts) / shown_parts}}
                    : PanelActions();
}

PanelActions draw_eye_dome(const AppearanceContent& appearance) {
    double strength = appearance.eye_dome;
    const bool is_moved = draw_slider("Eye-dome lighting", strength, 0.0, 1.0, "{:.2f}");
    tip("Darker valleys, and ground behind ridges");
    constexpr double shown_parts = 100.0; // of 1
    return is_moved ? PanelActions{SetEyeDome{std::round(strength * shown_parts) / shown_parts}}
                    : PanelActions();
}

PanelActions draw_contours(const AppearanceContent& appearance) {
    constexpr std::array intervals{0.0, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0};
    const auto name_of = [](double metres) {
        return metres > 0.0 ? fmt::format("every {} m", metres) : std::string("none");
    };
    PanelActions actions;
    muted_text("Contours");
    ImGui::SetNextItemWidth(-1.0F);
    if (ImGui::BeginCombo("##contours", name_of(appearance.contours).c_str())) {
        for (const double metres : intervals) {
            if (ImGui::Selectable(name_of(metres).c_str(), appearance.contours == metres)) {
                actions.emplace_back(SetContours{metres});
            }
        }
        ImGui::EndCombo();
    }
    bool has_labels = appearance.labels_contours;
    if (appearance.contours > 0.0 && ImGui::Checkbox("Heights on bold lines", &has_labels)) {
        actions.emplace_back(SetContourLabels{has_labels});
    }
    return actions;
}

PanelActions draw_imagery(const AppearanceContent& appearance) {
    if (!appearance.imagery_share) {
        return {};
    }
    double share = *appearance.imagery_share;
    ImGui::BeginDisabled(!appearance.fixed_exaggeration.empty());
    const bool is_moved = draw_slider("Imagery over the colours", share, 0.0, 1.0, "{:.2f}");
    ImGui::EndDisabled();
    constexpr double shown_parts = 100.0; // of 1
    return is_moved ? PanelActions{SetImageryShare{std::round(share * shown_parts) / shown_parts}}
                    : PanelActions();
}

PanelActions draw_ramps(const AppearanceContent& appearance) {
    PanelActions actions;
    if (appearance.ramp.empty()) {
        return actions;
    }
    muted_text("Colours of heights");
    ImGui::SetNextItemWidth(-1.0F);
    ImGui::BeginDisabled(!appearance.fixed_exaggeration.empty());
    if (ImGui::BeginCombo("##ramp", appearance.ramp.c_str())) {
        for (const std::string& name : appearance.ramps) {
            if (ImGui::Selectable(name.c_str(), name == appearance.ramp)) {
                actions.emplace_back(SetRamp{name});
            }
        }
        ImGui::EndCombo();
    }
    ImGui::EndDisabled();
    return actions;
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

int days_of_year(int year) {
    const bool is_leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    return is_leap ? 366 : 365;
}

// A box that does what a key does.
PanelActions draw_switch(const char* label, bool is_on, Key key) {
    return tick(label, is_on) ? PanelActions{PressKey{key}} : PanelActions();
}

} // namespace

Result<SetSun> sun_at(const geo::UniversalTime& time, const AppearanceContent& appearance) {
    const auto sun =
        geo::sun_position(time, appearance.on_earth->latitude, appearance.on_earth->longitude);
    if (!sun) {
        return sun.error();
    }
    if (sun->altitude < lowest_sun) {
        return Error{fmt::format("the sun is {:.1f} degrees below the horizon at that time, at "
                                 "most {} was expected",
                                 -sun->altitude, -lowest_sun)};
    }
    const double azimuth =
        std::fmod(sun->azimuth + appearance.true_north + full_circle, full_circle);
    return SetSun{azimuth, sun->altitude};
}

geo::UniversalTime AppearancePanel::time() const {
    const bool has_days = year_ >= geo::first_sun_year && year_ <= geo::last_sun_year;
    geo::UniversalTime time =
        has_days ? geo::day_of_year(
                       year_, std::min(static_cast<int>(std::lround(day_)), days_of_year(year_)))
                 : geo::UniversalTime{.year = year_};
    time.hours = hours_;
    return time;
}

PanelActions AppearancePanel::draw_date(const AppearanceContent& appearance) {
    constexpr double last_minute = 24.0 - 1.0 / 60.0;
    if (!appearance.on_earth) {
        return {};
    }
    const geo::UniversalTime shown = time();
    const int minutes = static_cast<int>(std::lround(60.0 * hours_));
    row("Or by date", fmt::format("{:04}-{:02}-{:02}", shown.year, shown.month, shown.day));
    ImGui::SetNextItemWidth(-1.0F);
    bool is_moved = ImGui::InputInt("##year", &year_, 1, 10);
    tip(fmt::format("The year, {} to {}", geo::first_sun_year, geo::last_sun_year));
    ImGui::SetNextItemWidth(-1.0F);
    constexpr double first = 1.0;
    const double last = days_of_year(shown.year);
    is_moved =
        ImGui::SliderScalar("##day", ImGuiDataType_Double, &day_, &first, &last, "") || is_moved;
    row("and time, UTC", fmt::format("{:02}:{:02}", minutes / 60, minutes % 60));
    ImGui::SetNextItemWidth(-1.0F);
    constexpr double midnight = 0.0;
    is_moved = ImGui::SliderScalar("##hours", ImGuiDataType_Double, &hours_, &midnight,
                                   &last_minute, "") ||
               is_moved;
    if (!note_.empty()) {
        wrapped_muted_text(note_);
    }
    if (!is_moved) {
        return {};
    }
    const auto sun = sun_at(time(), appearance);
    note_ = sun ? std::string() : sun.error().message;
    return sun ? PanelActions{*sun} : PanelActions();
}

PanelActions AppearancePanel::draw(const PanelContent& content, const Fonts& fonts) {
    const AppearanceContent& appearance = content.appearance;
    const FontScope small(fonts.small);
    PanelActions actions;
    section(fonts.heading, "Sun and air");
    actions += draw_sun(appearance);
    actions += draw_date(appearance);
    actions += draw_air(appearance);
    section(fonts.heading, "Picture");
    actions += draw_ramps(appearance);
    actions += draw_imagery(appearance);
    actions += draw_contours(appearance);
    actions += draw_grain(appearance);
    actions += draw_eye_dome(appearance);
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
