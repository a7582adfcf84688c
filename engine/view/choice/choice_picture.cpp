#include "engine/view/choice/choice_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <glm/common.hpp>

#include "engine/core/check.h"
#include "engine/view/triangles/tile_cut.h"

// The colours of Okabe and Ito (2008), which people with any colour vision tell apart.

namespace reljef::view {
namespace {

constexpr std::array colors_of_levels{Rgba8{0, 114, 178}, Rgba8{86, 180, 233}, Rgba8{0, 158, 115},
                                      Rgba8{240, 228, 66}, Rgba8{204, 121, 167}};

// A tile in samples of its terrain.
struct TintedTile {
    glm::dvec2 first{0.0};
    glm::dvec2 last{0.0};
    Rgba8 color;

    [[nodiscard]] bool contains(glm::dvec2 place) const {
        return place.x >= first.x && place.y >= first.y && place.x <= last.x && place.y <= last.y;
    }
};

std::vector<TintedTile> tinted_tiles(const DrawList& list) {
    const bool rays_draw_all = list.stats.choice && list.stats.choice->tiles_as_triangles == 0;
    std::vector<TintedTile> tiles;
    tiles.reserve(list.tiles.size());
    for (const TileDraw& draw : list.tiles) {
        const TileSurface surface = surface_of(draw);
        const int level = draw.tile->borrows ? 0 : draw.tile->id.level;
        tiles.push_back({surface.placement.on_terrain(glm::dvec2(surface.samples.first)),
                         surface.placement.on_terrain(glm::dvec2(surface.samples.last())),
                         rays_draw_all ? color_of_rays(level) : color_of_triangles()});
    }
    return tiles;
}

Rgba8 color_of_rest(const DrawList& list) {
    return list.stats.choice && list.stats.choice->typical ? color_of_typical() : color_of_rays(0);
}

Rgba8 tinted(Rgba8 pixel, Rgba8 tint) {
    constexpr glm::vec3 luminance{0.2126F, 0.7152F, 0.0722F}; // ITU-R BT.709
    constexpr float darkest = 0.15F;
    const float light = glm::dot(luminance, linear_from_rgba8(pixel));
    return rgba8_from_linear(linear_from_rgba8(tint) * (darkest + 1.5F * std::sqrt(light)));
}

} // namespace

Rgba8 color_of_triangles() {
    return {230, 159, 0};
}

Rgba8 color_of_typical() {
    return {213, 94, 0};
}

Rgba8 color_of_rays(int level) {
    const auto last = static_cast<int>(colors_of_levels.size()) - 1;
    return colors_of_levels.at(static_cast<std::size_t>(std::clamp(level, 0, last)));
}

void tint_choice(Image& picture, const HitBuffer& hits, const DrawList& list) {
    check(picture.cols() == hits.cols() && picture.rows() == hits.rows(),
          "a picture and hits of one size were expected");
    const std::vector<TintedTile> tiles = tinted_tiles(list);
    const Rgba8 rest = color_of_rest(list);
    std::size_t last = 0; // neighbours show the same tile
    for (int y = 0; y < hits.rows(); ++y) {
        for (int x = 0; x < hits.cols(); ++x) {
            const Hit& hit = hits(x, y);
            if (hit.is_sky()) {
                continue;
            }
            const glm::dvec2 place = hit.place();
            if (last >= tiles.size() || !tiles[last].contains(place)) {
                const auto found =
                    std::find_if(tiles.begin(), tiles.end(),
                                 [&](const TintedTile& tile) { return tile.contains(place); });
                last = static_cast<std::size_t>(found - tiles.begin());
            }
            picture(x, y) = tinted(picture(x, y), last < tiles.size() ? tiles[last].color : rest);
        }
    }
}

} // namespace reljef::view
