#pragma once

#include "app/viewer/panels/panel_content.h"
#include "app/viewer/panels/toolkit/interface.h"
#include "engine/view/picture/scale_bar.h"

namespace reljef::app {

using view::scale_bar;
using view::ScaleBar;

/// The compass, an arrow to north on the map, and the scale at the middle of the view.
void draw_compass(const PanelContent& content, const Area& area, const Fonts& fonts);

} // namespace reljef::app
