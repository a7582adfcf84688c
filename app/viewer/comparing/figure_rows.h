#pragma once

#include <span>
#include <vector>

#include "app/viewer/panels/panel_content.h"
#include "engine/session/comparing/error_figures.h"

namespace reljef::app {

/// The figures of one picture or two as rows.
std::vector<FigureContent> figure_rows(std::span<const session::ErrorFigures> figures);

/// The colours of the error map, upwards.
std::vector<LegendStop> error_colors();

} // namespace reljef::app
