#pragma once

#include <string>

#include "app/viewer/panels/panel_action.h"
#include "app/viewer/panels/panel_content.h"
#include "app/viewer/panels/toolkit/interface.h"

namespace reljef::app {

/// Sun, air, colours, exaggeration, samples, and the switches of the view.
class AppearancePanel {
public:
    PanelActions draw(const PanelContent& content, const Fonts& fonts);

private:
    PanelActions draw_date(const AppearanceContent& appearance);

    double day_ = 172.0; // of the year: the June solstice
    double hours_ = 10.0;
    std::string note_; // why the sun does not move; empty: it does
};

} // namespace reljef::app
