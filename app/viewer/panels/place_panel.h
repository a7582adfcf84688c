#pragma once

#include "app/viewer/panels/panel_content.h"
#include "app/viewer/panels/panel_text.h"
#include "app/viewer/panels/toolkit/interface.h"

namespace reljef::app {

/// The bar at the lower edge: eye, ground under the pointer, speed, and the keys of the panels. A
/// click changes how places are written.
class PlacePanel {
public:
    void draw(const PanelContent& content, const Area& area, const Fonts& fonts);

private:
    PlaceFormat format_ = PlaceFormat::geographic;
};

} // namespace reljef::app
