#pragma once

#include "app/viewer/panels/panel_content.h"
#include "app/viewer/panels/toolkit/interface.h"

namespace reljef::app {

/// All keys. Returns whether the user closes it.
bool draw_help(const PanelContent& content, const Area& area, const Fonts& fonts);

} // namespace reljef::app
