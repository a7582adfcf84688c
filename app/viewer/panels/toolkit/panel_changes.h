#pragma once

#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <imgui.h>

#include "app/viewer/panels/toolkit/pixel_area.h"

namespace reljef::app {

/// Finds what a frame of panels changes since the frame before.
class PanelChanges {
public:
    /// Disjoint rectangles with all that differs from the data of the last call; all of the window
    /// if that had another size or other panels, and at first.
    std::vector<PixelArea> update(const ImDrawData& data);
    /// The next update() finds all of the window.
    void forget() { size_ = {0, 0}; }

private:
    struct List {
        std::string panel;
        std::vector<ImDrawVert> vertices;
        std::vector<ImDrawCmd> commands;
    };

    std::vector<List> lists_;
    glm::ivec2 size_{0};
};

} // namespace reljef::app
