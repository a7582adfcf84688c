#pragma once

#include <optional>
#include <string>

#include "app/viewer/panels/panel_action.h"
#include "app/viewer/panels/panel_content.h"
#include "app/viewer/panels/toolkit/interface.h"
#include "engine/core/result.h"
#include "engine/geo/sun_position.h"

namespace reljef::app {

/// The end of astronomical twilight, degrees: a lower sun gives no light.
inline constexpr double lowest_sun = -18.0;

/// The sun over the terrain's middle. Fails for a time that geo::sun_position() does not know, and
/// a sun below lowest_sun. Precondition: `appearance.on_earth`.
Result<SetSun> sun_at(const geo::UniversalTime& time, const AppearanceContent& appearance);

/// Sun, air, colours, exaggeration, samples, and the switches of the view.
class AppearancePanel {
public:
    PanelActions draw(const PanelContent& content, const Fonts& fonts);

    /// The date and time whose sun is shown, as ISO 8601 in Universal Time; empty: the sun is not
    /// that of a date. Precondition, as of type_date(): `appearance.on_earth`.
    std::string date(const AppearanceContent& appearance);
    /// Moves the sun to that of a date, at noon without a time.
    PanelActions type_date(std::string text, const AppearanceContent& appearance);
    /// Why the sun does not move to the last date; empty: it does.
    [[nodiscard]] const std::string& note() const { return note_; }

private:
    // Until the sun is moved otherwise.
    struct Dated {
        bool is_date = false; // false: what was typed is none
        SetSun sun;           // of the date; of a night, as it was
        SetSun before;        // the last frames may show it still
    };

    [[nodiscard]] geo::UniversalTime time() const;
    void set_time(const geo::UniversalTime& time);
    void take_first_date(const AppearanceContent& appearance);
    [[nodiscard]] bool has_date(const SetSun& now);
    PanelActions choose(const geo::UniversalTime& time, const AppearanceContent& appearance);
    PanelActions draw_date(const AppearanceContent& appearance);
    PanelActions draw_date_sliders(const AppearanceContent& appearance, bool is_dated);

    int year_ = 2026;
    double day_ = 172.0; // of the year: the June solstice
    double hours_ = 10.0;
    std::optional<Dated> dated_;
    bool has_first_date_ = false; // or knows that there is none
    std::string note_;
};

} // namespace reljef::app
