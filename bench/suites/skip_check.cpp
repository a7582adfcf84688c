#include "bench/suites/skip_check.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "engine/truth/geometric_error.h"
#include "engine/view/choice/ray_error.h"

namespace reljef::bench {
namespace {

bool has_same_bits(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

bool has_same_bits(const Hit& a, const Hit& b) {
    return has_same_bits(a.col, b.col) && has_same_bits(a.row, b.row) &&
           has_same_bits(a.height, b.height) && has_same_bits(a.depth, b.depth) &&
           has_same_bits(a.col_low, b.col_low) && has_same_bits(a.row_low, b.row_low);
}

int levels_between(Rgba8 a, Rgba8 b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

void compare_colors(const Image& all, const Image& without, RowSkip::Difference& found) {
    const auto a = all.samples();
    const auto b = without.samples();
    for (std::size_t i = 0; i < a.size(); ++i) {
        const int levels = levels_between(a[i], b[i]);
        found.pixels += levels > 0 ? 1U : 0U;
        found.levels = std::max(found.levels, levels);
    }
}

// How far hits are from their pixels, and how far rounding moves them.
class HitDistance {
public:
    HitDistance(const scene::Scene& scene, const scene::Node& terrain, glm::ivec2 size)
        : surface_(*terrain.get<scene::TerrainNode>()->surface),
          view_{surface_.heightfield().heights.view(), surface_.placement(),
                terrain.world_from_local(), scene.camera()},
          size_(size), error_of_rays_(scene.camera(), size, surface_, view::steepest(surface_),
                                      glm::dvec3(terrain.world_from_local()[3])) {}

    // Keeps the hit that is the farthest for its tolerance; none is farther than one without place.
    void add(glm::ivec2 pixel, const Hit& hit, bool rounds, RowSkip::Difference& found) const {
        if (!truth::shows_terrain(hit)) {
            return;
        }
        const double px = truth::reprojection_error(view_, size_, pixel, hit);
        const double tolerance = rounds ? error_of_rays_.at(hit.depth) : 0.0;
        if (is_farther(px, tolerance, found)) {
            found.max_px = px;
            found.tolerance_px = tolerance;
        }
    }

private:
    static bool is_farther(double px, double tolerance, const RowSkip::Difference& than) {
        if (!std::isfinite(px) || !std::isfinite(than.max_px)) {
            return std::isfinite(than.max_px);
        }
        return tolerance == 0.0 && than.tolerance_px == 0.0
                   ? px > than.max_px
                   : px * than.tolerance_px >= than.max_px * tolerance;
    }

    const scene::TerrainSurface& surface_;
    truth::SurfaceView view_;
    glm::ivec2 size_;
    view::RayError error_of_rays_;
};

} // namespace

Result<DrawnPicture> draw_picture(const scene::Scene& scene, session::SceneRenderer& renderer) {
    if (const auto stats = renderer.draw(scene, true); !stats) {
        return stats.error();
    }
    Image colors = renderer.read_color();
    auto hits = renderer.draw_hits(scene);
    return hits ? Result<DrawnPicture>(DrawnPicture{std::move(colors), std::move(*hits)})
                : hits.error();
}

RowSkip::Difference difference_of(const scene::Scene& scene, const scene::Node& terrain,
                                  const DrawnPicture& all, const DrawnPicture& without,
                                  bool hits_round) {
    RowSkip::Difference found;
    compare_colors(all.colors, without.colors, found);
    const HitDistance distance(scene, terrain, {all.hits.cols(), all.hits.rows()});
    for (int row = 0; row < all.hits.rows(); ++row) {
        for (int col = 0; col < all.hits.cols(); ++col) {
            const Hit& a = all.hits(col, row);
            const Hit& b = without.hits(col, row);
            if (has_same_bits(a, b)) {
                continue;
            }
            ++found.hits;
            found.edges += truth::shows_terrain(a) != truth::shows_terrain(b) ? 1U : 0U;
            distance.add({col, row}, a, hits_round, found);
            distance.add({col, row}, b, hits_round, found);
        }
    }
    return found;
}

} // namespace reljef::bench
