#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "app/viewer/panels/panel_action.h"
#include "app/viewer/panels/panel_content.h"
#include "app/viewer/panels/toolkit/interface.h"

namespace reljef::app {

/// The bookmarks of the terrain, to fly to, add, name and delete, and the speed of the flight.
class BookmarkPanel {
public:
    PanelActions draw(const PanelContent& content, const Fonts& fonts);

private:
    using Name = std::array<char, 256>; // UTF-8, ends with 0

    PanelActions draw_new();
    PanelActions draw_row(std::size_t row, const Bookmark& bookmark);
    PanelActions draw_name_field();

    Name new_name_{};
    struct Renamed {
        std::size_t row = 0;
        Bookmark bookmark;
    };
    std::optional<Renamed> renamed_; // while its name is edited
    Name other_name_{};
    bool begins_renaming_ = false; // in the last frame
};

} // namespace reljef::app
