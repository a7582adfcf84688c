#pragma once

#include "app/viewer/panels/panel_action.h"
#include "app/viewer/panels/panel_content.h"
#include "app/viewer/panels/toolkit/interface.h"

namespace reljef::app {

/// What the view is compared with, both frame times, and the errors of the view.
PanelActions draw_compare(const PanelContent& content, const Fonts& fonts);

/// The names of both pictures beside the line between them, and the line's handle; nothing if
/// nothing is compared. `view`: the part of the window without the columns of panels.
void draw_wipe(const PanelContent& content, const Area& view, const Fonts& fonts);

} // namespace reljef::app
