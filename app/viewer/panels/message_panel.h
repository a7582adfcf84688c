#pragma once

#include <string>

#include "app/viewer/panels/panel_action.h"
#include "app/viewer/panels/panel_content.h"
#include "app/viewer/panels/toolkit/interface.h"

namespace reljef::app {

/// New messages and the progress of background work, upwards from the lower edge of the area;
/// nothing if there are none.
void draw_messages(const PanelContent& content, const Area& area, const Fonts& fonts);

/// Why there is no scene, and how to close the window.
void draw_failure(const std::string& sentence, const Area& area, const Fonts& fonts);

/// All messages since the start, the latest first.
void draw_log(const PanelContent& content, const Fonts& fonts);

} // namespace reljef::app
