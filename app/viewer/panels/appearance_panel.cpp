#include "app/viewer/panels/appearance_panel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "app/viewer/panels/toolkit/number_control.h"
#include "app/viewer/panels/toolkit/widgets.h"
#include "engine/scene/graph/daylight.h"

namespace reljef::app {
namespace {

constexpr double max_altitude = 90.0; // degrees
constexpr double full_circle = 360.0;
constexpr double min_factor = 0.1; // of the slider; the option takes any
constexpr double max_factor = 20.0;
constexpr double smallest_factor = 1e-6; // typed
constexpr const char* date_hint = "no date: 2026-06-21T12:00";
constexpr const char* noon = "T12:00";
constexpr std::array sample_counts{1, 2, 4, 8, 16};

float width_of(const char* letters) {
    return ImGui::CalcTextSize(letters).x;
}

// Of a control from 0 to a maximum.
NumberControl share_control(double max, std::string_view meaning) {
    return {.slider = {0.0, max}, .meaning = meaning};
}

SetSun sun_of(const AppearanceContent& appearance) {
    return {std::fmod(appearance.light.azimuth + full_circle, full_circle),
            appearance.light.altitude};
}

PanelActions draw_sun(const AppearanceContent& appearance) {
    SetSun sun = sun_of(appearance);
    const auto azimuth = number_row("Azimuth",
                                    {.slider = {0.0, full_circle},
                                     .decimals = 0,
                                     .unit = "\u00b0",
                                     .meaning = "Of the sun, from north clockwise"},
                                    sun.azimuth);
    const auto altitude =
        number_row("Altitude",
                   {.slider = {lowest_sun, max_altitude},
                    .decimals = 0,
                    .unit = "\u00b0",
                    .meaning = "Below 0\u00b0 the sun has set: twilight, down to -18\u00b0"},
                   sun.altitude);
    sun = {azimuth.value_or(sun.azimuth), altitude.value_or(sun.altitude)};
    return azimuth || altitude ? PanelActions{sun} : PanelActions();
}

PanelActions draw_air(const AppearanceContent& appearance) {
    constexpr double usual = 1e5; // metres
    constexpr double kilometre = 1e3;
    PanelActions actions;
    if (const auto turbidity = number_row("Turbidity of the air",
                                          {.slider = {scene::min_turbidity, scene::max_turbidity},
                                           .decimals = 1,
                                           .meaning = "1: no haze"},
                                          appearance.turbidity)) {
        actions.emplace_back(SetTurbidity{*turbidity});
    }
    bool is_hazy = appearance.visibility.value_or(0.0) > 0.0;
    if (appearance.visibility && ImGui::Checkbox("Haze", &is_hazy)) {
        actions.emplace_back(SetVisibility{is_hazy ? usual : 0.0});
    }
    if (appearance.visibility.value_or(0.0) > 0.0) {
        if (const auto visibility = number_row("Visibility",
                                               {.slider = {1.0, 1000.0},
                                                .typed = Interval{0.01, 1e5},
                                                .decimals = 0,
                                                .is_logarithmic = true,
                                                .unit = "km",
                                                .meaning = "How far one sees through the haze"},
                                               *appearance.visibility / kilometre)) {
            actions.emplace_back(SetVisibility{kilometre * *visibility});
        }
    }
    return actions;
}

PanelActions draw_grain(const AppearanceContent& appearance) {
    const auto strength = number_row(
        "Grain of near ground",
        share_control(
            scene::max_grain,
            "Fine structure that the data do not have, of soil, scree, grass, rock and snow. "
            "Hits and errors are without it."),
        appearance.grain);
    return strength ? PanelActions{SetGrain{*strength}} : PanelActions();
}

PanelActions draw_eye_dome(const AppearanceContent& appearance) {
    const auto strength = number_row("Eye-dome lighting",
                                     share_control(1.0, "Darker valleys, and ground behind ridges"),
                                     appearance.eye_dome);
    return strength ? PanelActions{SetEyeDome{*strength}} : PanelActions();
}

PanelActions draw_contours(const AppearanceContent& appearance) {
    constexpr const char* metre = "  m";
    constexpr std::array intervals{0.0, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0};
    const auto name_of = [](double metres) {
        return metres > 0.0 ? fmt::format("every {} m", metres) : std::string("none");
    };
    PanelActions actions;
    muted_text("Contours");
    ImGui::PushID("contours");
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - number_box_width() - width_of(metre));
    const auto typed = number_box(number_text(appearance.contours, 6), number_box_width(),
                                  "Metres of height from one line to the next; 0: none");
    ImGui::PopID();
    ImGui::SameLine(0.0F, 0.0F);
    muted_text(metre);
    if (typed) {
        actions.emplace_back(SetContours{*typed});
    }
    ImGui::SetNextItemWidth(-1.0F);
    if (ImGui::BeginCombo("##contours", name_of(appearance.contours).c_str())) {
        for (const double metres : intervals) {
            if (ImGui::Selectable(name_of(metres).c_str(), appearance.contours == metres)) {
                actions.emplace_back(SetContours{metres});
            }
        }
        ImGui::EndCombo();
    }
    warning_text(appearance.faded_contours);
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
    ImGui::BeginDisabled(!appearance.fixed_exaggeration.empty());
    const auto share = number_row("Imagery over the colours",
                                  share_control(1.0, "0: the colours of heights alone"),
                                  *appearance.imagery_share);
    ImGui::EndDisabled();
    return share ? PanelActions{SetImageryShare{*share}} : PanelActions();
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
    const double factor = appearance.exaggeration;
    ImGui::BeginDisabled(!appearance.fixed_exaggeration.empty());
    const auto chosen = number_row("Vertical exaggeration",
                                   {.slider = {min_factor, max_factor},
                                    .typed = Interval{smallest_factor, appearance.max_exaggeration},
                                    .is_logarithmic = true,
                                    .unit = "\u00d7",
                                    .meaning = appearance.fixed_exaggeration},
                                   factor);
    ImGui::EndDisabled();
    const bool is_reset = factor != 1.0 && ImGui::SmallButton("true heights");
    if (is_reset) {
        return {SetExaggeration{1.0}};
    }
    return chosen ? PanelActions{SetExaggeration{*chosen}} : PanelActions();
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

double day_number(const geo::UniversalTime& time) {
    int day = 1;
    for (geo::UniversalTime at = geo::day_of_year(time.year, day);
         at.month != time.month || at.day != time.day; at = geo::day_of_year(time.year, day)) {
        ++day;
    }
    return day;
}

std::string date_text(const geo::UniversalTime& time) {
    constexpr long last_second = 86'399;
    const auto seconds = static_cast<int>(std::min(std::lround(3600.0 * time.hours), last_second));
    const std::string minutes = fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}", time.year, time.month,
                                            time.day, seconds / 3600, seconds / 60 % 60);
    return seconds % 60 == 0 ? minutes : minutes + fmt::format(":{:02}", seconds % 60);
}

bool is_same_sun(const SetSun& a, const SetSun& b) {
    constexpr double rounding = 1e-6; // degrees
    const double turn = std::remainder(a.azimuth - b.azimuth, full_circle);
    return std::abs(turn) < rounding && std::abs(a.altitude - b.altitude) < rounding;
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
    geo::UniversalTime time =
        geo::day_of_year(year_, std::min(static_cast<int>(day_), days_of_year(year_)));
    time.hours = hours_;
    return time;
}

// Whether the sun is that of the date. Forgets a date that it is not of.
bool AppearancePanel::has_date(const SetSun& now) {
    if (dated_ && is_same_sun(now, dated_->sun)) {
        dated_->before = dated_->sun;
    } else if (dated_ && !is_same_sun(now, dated_->before)) {
        dated_.reset();
        note_.clear();
    }
    return dated_ && dated_->is_date;
}

void AppearancePanel::set_time(const geo::UniversalTime& time) {
    year_ = time.year;
    day_ = day_number(time);
    hours_ = time.hours;
}

// That of the start, which has_date() forgets if the sun has moved since.
void AppearancePanel::take_first_date(const AppearanceContent& appearance) {
    if (std::exchange(has_first_date_, true) || !appearance.sun_time) {
        return;
    }
    if (const auto sun = sun_at(*appearance.sun_time, appearance)) {
        set_time(*appearance.sun_time);
        dated_ = Dated{true, *sun, *sun};
    }
}

std::string AppearancePanel::date(const AppearanceContent& appearance) {
    take_first_date(appearance);
    return has_date(sun_of(appearance)) ? date_text(time()) : std::string();
}

PanelActions AppearancePanel::choose(const geo::UniversalTime& time,
                                     const AppearanceContent& appearance) {
    const SetSun now = sun_of(appearance);
    const auto sun = sun_at(time, appearance);
    const auto& place = *appearance.on_earth;
    const auto position = geo::sun_position(time, place.latitude, place.longitude);
    const bool is_date = static_cast<bool>(position);
    if (is_date) {
        set_time(time);
    }
    note_ = sun ? std::string() : sun.error().message;
    dated_ = Dated{is_date, sun ? *sun : now, now};
    return sun ? PanelActions{*sun} : PanelActions();
}

PanelActions AppearancePanel::type_date(std::string text, const AppearanceContent& appearance) {
    std::replace(text.begin(), text.end(), ' ', 'T');
    if (text.empty()) {
        return {};
    }
    const auto time = geo::universal_time(text.find('T') == std::string::npos ? text + noon : text);
    if (!time) {
        note_ = time.error().message;
        const SetSun now = sun_of(appearance);
        dated_ = Dated{false, now, now};
        return {};
    }
    return choose(*time, appearance);
}

PanelActions AppearancePanel::draw_date(const AppearanceContent& appearance) {
    if (!appearance.on_earth) {
        return {};
    }
    std::array<char, 32> text{};
    const std::string shown = date(appearance);
    std::copy(shown.begin(), shown.end(), text.begin());
    muted_text("Or by date and time, UTC");
    ImGui::SetNextItemWidth(-1.0F);
    ImGui::PushStyleColor(ImGuiCol_Text, // of a night, the sun has not moved there
                          in_imgui(note_.empty() ? palette::text : palette::muted));
    const bool is_typed = ImGui::InputTextWithHint("##date", date_hint, text.data(), text.size(),
                                                   ImGuiInputTextFlags_EnterReturnsTrue |
                                                       ImGuiInputTextFlags_AutoSelectAll);
    ImGui::PopStyleColor();
    tip(fmt::format("Type a date from {} to {} as 2026-06-21T12:00 and press Enter. Empty: the sun "
                    "is not that of a date.",
                    geo::first_sun_year, geo::last_sun_year));
    PanelActions actions = is_typed ? type_date(text.data(), appearance) : PanelActions();
    actions += draw_date_sliders(appearance, !shown.empty());
    if (!note_.empty()) {
        warning_text(note_);
    }
    return actions;
}

PanelActions AppearancePanel::draw_date_sliders(const AppearanceContent& appearance,
                                                bool is_dated) {
    constexpr double first_day = 1.0;
    constexpr double midnight = 0.0;
    constexpr double last_minute = 24.0 - 1.0 / 60.0;
    constexpr float pale = 0.5F;
    const double last_day = days_of_year(year_);
    double day = day_;
    double hours = hours_;
    if (!is_dated) {
        ImGui::PushStyleVar(ImGuiStyleVar_Alpha, pale);
    }
    ImGui::SetNextItemWidth(-1.0F);
    bool is_moved =
        ImGui::SliderScalar("##day", ImGuiDataType_Double, &day, &first_day, &last_day, "");
    tip("The day of the year");
    ImGui::SetNextItemWidth(-1.0F);
    is_moved =
        ImGui::SliderScalar("##hours", ImGuiDataType_Double, &hours, &midnight, &last_minute, "") ||
        is_moved;
    tip("The time of the day");
    if (!is_dated) {
        ImGui::PopStyleVar();
    }
    if (!is_moved) {
        return {};
    }
    geo::UniversalTime moved = geo::day_of_year(year_, static_cast<int>(std::lround(day)));
    moved.hours = std::round(60.0 * hours) / 60.0;
    return choose(moved, appearance);
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
