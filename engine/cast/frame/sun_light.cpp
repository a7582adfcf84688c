#include "engine/cast/frame/sun_light.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include "engine/scene/streaming/tile_stream.h"

namespace reljef::cast {
namespace {

constexpr int cells_a_word = 16;
constexpr double share_of_heights = 1.0 / 2048.0; // that sun rays may begin above the surface

static_assert(static_cast<std::int32_t>(scene::CertainSun::unknown) == 0 &&
              static_cast<std::int32_t>(scene::CertainSun::lit) == sun_certain &&
              static_cast<std::int32_t>(scene::CertainSun::dark) == shadow_certain);

// As BlockJob::certain_sun.
std::vector<std::int32_t> packed(const Grid<scene::CertainSun>& known) {
    const auto stride = static_cast<std::size_t>(certain_stride(known.cols()));
    std::vector<std::uint32_t> words(stride * static_cast<std::size_t>(known.rows()));
    for (int row = 0; row < known.rows(); ++row) {
        for (int col = 0; col < known.cols(); ++col) {
            const std::size_t word = static_cast<std::size_t>(row) * stride +
                                     static_cast<std::size_t>(col / cells_a_word);
            words[word] |= static_cast<std::uint32_t>(known(col, row))
                           << static_cast<unsigned>(2 * (col % cells_a_word));
        }
    }
    return {words.begin(), words.end()};
}

// Metres by which sun rays begin above the surface at most: packet_light-inl.h adds what floats
// round of the tile's heights and of the ray's, from the height at which it begins.
double max_sun_lift(const RayTile& tile, const PictureRays& rays) {
    constexpr double rounding = 0x1p-18; // a few of 2^-20
    const glm::dvec3 first = rays.origin.first + rays.anchor * rays.direction.first;
    const glm::dvec3 extent = glm::abs(rays.origin.right + rays.anchor * rays.direction.right) *
                                  static_cast<double>(rays.size.x) +
                              glm::abs(rays.origin.down + rays.anchor * rays.direction.down) *
                                  static_cast<double>(rays.size.y);
    const terrain::MinMax total = tile.total();
    return rounding *
           (std::max(std::abs(total.low), std::abs(total.high)) + std::abs(first.z) + extent.z);
}

// Metres within a cell for which sun rays begin above the surface: they begin at least 2^-19 of the
// heights above a place whose column and row are rounded by 2^-25 of the side. Half of it is left.
double max_variation(const RayTile& tile) {
    const terrain::MinMax total = tile.total();
    const double lift = 0x1p-19 * std::max(std::abs(total.low), std::abs(total.high));
    const double rounded = 0x1p-25 * std::max(tile.cells().x, tile.cells().y);
    return 0.5 * lift / (2.0 * rounded);
}

// To the sun of a list, in samples of a terrain on a plane, or of its stream.
std::optional<glm::dvec3> direction_to_sun(const view::DrawList& list, const SeenTerrain& seen) {
    const auto light = view::light_on(list, seen.world_from_local);
    if (!light) {
        return std::nullopt;
    }
    const glm::dvec3 local = glm::inverse(light->world_from_local) * scene::to_light(light->sun);
    const scene::TerrainNode& node = *seen.node;
    glm::dvec3 to_sun = direction_in_samples(node.surface->placement(), local);
    if (seen.has_tiles) {
        to_sun *= glm::dvec3(glm::dvec2(node.stream->maker().reduction()), 1.0);
    }
    return to_sun;
}

// A world place in the samples of a terrain, or of its stream.
std::optional<glm::dvec3> sample_of(const SeenTerrain& seen, const glm::dmat4& local_from_world,
                                    glm::dvec3 world) {
    const scene::TerrainNode& node = *seen.node;
    const glm::dvec3 local(local_from_world * glm::dvec4(world, 1.0));
    const auto sample = node.surface->placement().sample_from_world(local);
    return sample && seen.has_tiles
               ? glm::dvec3(node.stream->maker().from_overview(glm::dvec2(*sample)), sample->z)
               : sample;
}

} // namespace

bool casts_shadows(const SeenTerrain& seen) {
    return seen.node->material.technique.options.shadow && !is_curved(*seen.node);
}

void add_sun(const view::DrawList& list, const SeenTerrain& seen, std::span<const SunSource> beside,
             PlacedTiles& placed) {
    const auto to_sun = direction_to_sun(list, seen);
    if (to_sun && to_sun->z > 0.0) { // else there is no such light
        add_sun_tiles(placed, beside, *to_sun);
    }
}

std::optional<ShadowGround> shadow_ground(const view::DrawList& list, const SeenTerrain& seen,
                                          const PlacedTiles& placed,
                                          std::vector<SunSource> beside) {
    const auto to_sun = casts_shadows(seen) ? direction_to_sun(list, seen) : std::nullopt;
    if (!to_sun) {
        return std::nullopt;
    }
    ShadowGround ground{std::move(beside), *to_sun, {}};
    for (const PlacedTile& tile : placed.tiles) {
        ground.sources.push_back({tile.tile, tile.first, tile.step});
    }
    ground.sample_of = [seen, from_world = glm::inverse(seen.world_from_local)](glm::dvec3 world) {
        return sample_of(seen, from_world, world);
    };
    return ground;
}

std::optional<scene::SunRays> certain_sun_rays(const view::DrawList& list, const SeenTerrain& seen,
                                               const PlacedTile& tile) {
    const auto on = view::light_on(list, seen.world_from_local);
    const auto to_sun = on ? scene::sun_in_samples(seen.node->surface->placement(), *on)
                           : std::optional<glm::dvec3>();
    const terrain::MinMax total = tile.tile->total();
    const double max_lift = share_of_heights * (total.high - total.low);
    if (!to_sun || tile.sun_tiles.empty() || max_sun_lift(*tile.tile, tile.rays) > max_lift) {
        return std::nullopt;
    }
    return scene::SunRays{*to_sun, max_lift, max_variation(*tile.tile)};
}

std::vector<std::int32_t> packed_certain_sun(const scene::TerrainSurface& surface,
                                             const scene::SunRays& rays) {
    return packed(scene::certain_sun(surface.heightfield().heights.view(), rays));
}

int certain_stride(int cells) {
    return (cells + cells_a_word - 1) / cells_a_word;
}

} // namespace reljef::cast
