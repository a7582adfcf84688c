#pragma once

#include "app/viewer/panels/panel_content.h"
#include "app/viewer/panels/toolkit/interface.h"

namespace reljef::app {

/// The colours of heights, with round heights beside them.
void draw_legend(const PanelContent& content, const Area& area, const Fonts& fonts);

} // namespace reljef::app
