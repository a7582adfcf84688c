#pragma once

#include "app/viewer/panels/panel_content.h"
#include "app/viewer/panels/toolkit/interface.h"

namespace reljef::app {

/// Terrain, technique, frame time with a plot, and the counts of the frame.
void draw_status(const PanelContent& content, const Area& area, const Fonts& fonts);

} // namespace reljef::app
