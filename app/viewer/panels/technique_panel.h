#pragma once

#include "app/viewer/panels/panel_action.h"
#include "app/viewer/panels/panel_content.h"
#include "app/viewer/panels/toolkit/interface.h"

namespace reljef::app {

/// The technique of the scene, or of each model, with its parameters and options, from the
/// catalogue.
PanelActions draw_technique(const PanelContent& content, const Fonts& fonts);

/// The selected model of the gallery in the view: the corners of a frame, and its name.
void draw_selected_model(const PanelContent& content, const Area& view, const Fonts& fonts);

} // namespace reljef::app
