#pragma once

#include <glm/vec2.hpp>

#include "app/viewer/panels/toolkit/interface.h"

namespace reljef::app {

/// The areas of all panels in a window; no two overlap, except the help, which covers others.
struct PanelLayout {
    bool has_room = false; ///< false: the window is too small for panels
    Area status;           ///< upper left
    Area legend;           ///< left, below the status; empty in low windows
    Area compass;          ///< lower left
    Area inspector;        ///< right
    Area place;            ///< the bar at the lower edge
    Area messages;         ///< above the bar, between the columns
    Area help;             ///< in the middle
    Area view;             ///< between the columns, above the bar
};

/// `scale`: pixels per unit of text.
PanelLayout layout_for(glm::ivec2 window, double scale);

} // namespace reljef::app
