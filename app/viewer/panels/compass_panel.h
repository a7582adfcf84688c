#pragma once

#include "app/viewer/panels/panel_content.h"
#include "app/viewer/panels/toolkit/interface.h"

namespace reljef::app {

/// A bar of a round length: 1, 2 or 5 times a power of ten.
struct ScaleBar {
    double metres = 0.0;
    double pixels = 0.0;
};

/// The longest bar of at most `max_pixels`. Preconditions: both are over 0.
ScaleBar scale_bar(double metres_per_pixel, double max_pixels);

/// The compass, an arrow to north on the map, and the scale at the middle of the view.
void draw_compass(const PanelContent& content, const Area& area, const Fonts& fonts);

} // namespace reljef::app
