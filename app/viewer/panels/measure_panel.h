#pragma once

#include "app/viewer/panels/panel_action.h"
#include "app/viewer/panels/panel_content.h"
#include "app/viewer/panels/toolkit/interface.h"

namespace reljef::app {

/// Picked points, the profile between the last two, and what can be saved.
PanelActions draw_measure(const PanelContent& content, const Fonts& fonts);

/// The points in the view, numbered and joined.
void draw_points(const PanelContent& content, const Fonts& fonts);

} // namespace reljef::app
