#include "app/viewer/panels/toolkit/panel_layout.h"

#include <algorithm>
#include <array>

#include <gtest/gtest.h>

namespace reljef::app {
namespace {

bool is_empty(const Area& area) {
    return area.size().x <= 0.0 || area.size().y <= 0.0;
}

bool overlap(const Area& a, const Area& b) {
    return !is_empty(a) && !is_empty(b) && a.low.x < b.high.x && b.low.x < a.high.x &&
           a.low.y < b.high.y && b.low.y < a.high.y;
}

TEST(PanelLayout, NoTwoPanelsOverlapAndAllLieInTheWindow) {
    for (const double scale : {1.0, 1.5, 2.0}) {
        for (int width = 300; width <= 8192; width += 97) {
            for (int height = 200; height <= 4400; height += 173) {
                const PanelLayout layout = layout_for({width, height}, scale);
                if (!layout.has_room) {
                    continue;
                }
                ASSERT_TRUE(layout.help.low.x >= 0.0 && layout.help.low.y >= 0.0 &&
                            layout.help.high.x <= width && layout.help.high.y <= height);
                const std::array areas{layout.status,    layout.legend, layout.compass,
                                       layout.inspector, layout.place,  layout.messages};
                for (std::size_t i = 0; i < areas.size(); ++i) {
                    ASSERT_TRUE(is_empty(areas[i]) ||
                                (areas[i].low.x >= 0.0 && areas[i].low.y >= 0.0 &&
                                 areas[i].high.x <= width && areas[i].high.y <= height))
                        << width << " x " << height << ", panel " << i;
                    for (std::size_t k = 0; k < i; ++k) {
                        ASSERT_FALSE(overlap(areas[i], areas[k]))
                            << width << " x " << height << ": panels " << k << " and " << i;
                    }
                }
            }
        }
    }
}

TEST(PanelLayout, UsualWindowsHaveAllPanelsAndTinyOnesHaveNone) {
    for (const glm::ivec2 size :
         {glm::ivec2(1024, 768), glm::ivec2(1920, 1080), glm::ivec2(7680, 4320)}) {
        const PanelLayout layout = layout_for(size, 1.0);
        EXPECT_TRUE(layout.has_room);
        EXPECT_FALSE(is_empty(layout.legend));
        EXPECT_FALSE(is_empty(layout.messages));
    }
    EXPECT_FALSE(layout_for({1, 1}, 1.0).has_room);
    EXPECT_FALSE(layout_for({320, 240}, 1.0).has_room);
    EXPECT_FALSE(layout_for({1024, 768}, 2.0).has_room);
}

} // namespace
} // namespace reljef::app
