#include "app/viewer/panels/toolkit/panel_layout.h"

#include <algorithm>

#include <glm/common.hpp>

namespace reljef::app {
namespace {

// Units of text.
constexpr double margin = 12.0;
constexpr double gap = 8.0;
constexpr double left_width = 248.0;
constexpr double right_width = 296.0;
constexpr double bar_height = 34.0;
constexpr double status_height = 240.0;
constexpr double compass_height = 72.0;
constexpr double legend_height = 178.0;
constexpr double message_height = 150.0;
constexpr double min_width = 560.0;
constexpr double min_height = 400.0;
constexpr glm::dvec2 help_size{620.0, 830.0}; // all keys; they scroll where there is no room

} // namespace

PanelLayout layout_for(glm::ivec2 window, double scale) {
    const glm::dvec2 size = glm::dvec2(window) / scale;
    PanelLayout layout;
    layout.has_room = size.x >= min_width && size.y >= min_height;
    if (!layout.has_room) {
        return layout;
    }
    const auto area = [&](glm::dvec2 low, glm::dvec2 high) {
        return Area{scale * low, scale * high};
    };
    const double left = margin + left_width;
    const double right = size.x - margin - right_width;
    const double bar = size.y - margin - bar_height;
    layout.place = area({margin, bar}, {size.x - margin, size.y - margin});
    const double above_bar = bar - gap;
    layout.compass = area({margin, above_bar - compass_height}, {left, above_bar});
    const double above_compass = above_bar - compass_height - gap;
    const double status_end = std::min(margin + status_height, above_compass);
    layout.status = area({margin, margin}, {left, status_end});
    if (above_compass - legend_height >= status_end + gap) {
        layout.legend = area({margin, above_compass - legend_height}, {left, above_compass});
    }
    layout.inspector = area({right, margin}, {size.x - margin, above_bar});
    layout.view = area({left + gap, margin}, {std::max(right - gap, left + gap), above_bar});
    layout.messages = area({left + gap, std::max(above_bar - message_height, margin)},
                           {std::max(right - gap, left + gap), above_bar});
    const glm::dvec2 help = glm::min(help_size, size - 2.0 * margin);
    layout.help = area(0.5 * (size - help), 0.5 * (size + help));
    return layout;
}

} // namespace reljef::app
