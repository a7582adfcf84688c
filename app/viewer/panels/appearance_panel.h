#pragma once

#include "app/viewer/panels/panel_action.h"
#include "app/viewer/panels/panel_content.h"
#include "app/viewer/panels/toolkit/interface.h"

namespace reljef::app {

/// Sun, exaggeration, samples, and the switches of the view.
PanelActions draw_appearance(const PanelContent& content, const Fonts& fonts);

} // namespace reljef::app
