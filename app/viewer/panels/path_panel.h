#pragma once

#include <cstddef>
#include <optional>

#include "app/viewer/panels/panel_action.h"
#include "app/viewer/panels/panel_content.h"
#include "app/viewer/panels/toolkit/interface.h"

namespace reljef::app {

/// The path as a timeline of keyframes, with what changes it, plays it and saves it.
class PathPanel {
public:
    PanelActions draw(const PanelContent& content, const Fonts& fonts);

private:
    struct Drag {
        std::optional<std::size_t> key; // absent: the time of the flight
        double seconds = 0.0;
        bool has_moved = false;
    };
    PanelActions draw_timeline(const PathContent& path);
    PanelActions draw_key(const PathContent& path);

    std::size_t key_ = 0; // selected
    std::optional<Drag> drag_;
};

} // namespace reljef::app
