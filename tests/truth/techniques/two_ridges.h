#pragma once

#include <cstddef>

#include "engine/core/color.h"
#include "engine/core/grid.h"
#include "engine/core/hit.h"

namespace reljef::test {

/// White ground of 64 by 64 samples with two ridges from west to east, each of three samples.
struct TwoRidges {
    Grid<float> heights{64, 64, 0.0F};
    Image colors{64, 64, Rgba8{255, 255, 255, 255}};

    TwoRidges(float red_height, float blue_height) {
        raise(38, red_height, {255, 0, 0, 255});
        raise(18, blue_height, {0, 0, 255, 255});
    }

private:
    void raise(int first, float height, Rgba8 color) {
        for (int i = 0; i < 5 * 64; ++i) {
            const bool is_foot = i < 64 || i >= 4 * 64;
            heights(i % 64, first + i / 64) = is_foot ? 0.0F : height;
            colors(i % 64, first + i / 64) = color;
        }
    }
};

/// Pixels that show the ground north of both ridges with some of a ridge's colour.
struct BlendedGround {
    int reddish = 0;
    int bluish = 0;

    BlendedGround(const HitBuffer& hits, const Image& shown) {
        for (std::size_t i = 0; i < hits.size(); ++i) {
            const Hit& hit = hits.samples()[i];
            if (!hit.is_sky() && hit.row < 15.0F) {
                const Rgba8 color = shown.samples()[i];
                reddish += color.r > color.b + 10 ? 1 : 0;
                bluish += color.b > color.r + 10 ? 1 : 0;
            }
        }
    }
};

} // namespace reljef::test
