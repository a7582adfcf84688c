#pragma once

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

private:
    [[nodiscard]] geo::UniversalTime time() const;
    PanelActions draw_date(const AppearanceContent& appearance);

    int year_ = 2026;
    double day_ = 172.0; // of the year: the June solstice
    double hours_ = 10.0;
    std::string note_; // why the sun does not move; empty: it does
};

} // namespace reljef::app
