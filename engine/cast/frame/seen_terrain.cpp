#include "engine/cast/frame/seen_terrain.h"

#include <algorithm>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>
#include <glm/vector_relational.hpp>

#include "engine/cast/globe_part.h"
#include "engine/scene/streaming/tile_stream.h"

namespace reljef::cast {
namespace {

Box samples_and_heights(const scene::TerrainNode& node) {
    const scene::TerrainSurface& surface = *node.surface;
    const Grid<float>& heights = surface.heightfield().heights;
    const terrain::MinMax total = surface.pyramid().total();
    const geo::WrappedRows rows = rows_of(node);
    Box bounds;
    bounds.add(glm::dvec3(0.0, rows.even_row(0.0), total.low));
    bounds.add(glm::dvec3(heights.cols() - 1.0, rows.even_row(heights.rows() - 1.0), total.high));
    return bounds;
}

SeenTerrain& found_or_added(std::vector<SeenTerrain>& seen, const scene::TerrainNode* node,
                            const glm::dmat4& world_from_local) {
    const auto found = std::find_if(seen.begin(), seen.end(),
                                    [&](const SeenTerrain& one) { return one.node == node; });
    return found != seen.end() ? *found
                               : seen.emplace_back(SeenTerrain{.node = node,
                                                               .world_from_local = world_from_local,
                                                               .local = {},
                                                               .samples = {}});
}

void add_tile(SeenTerrain& seen, const scene::TerrainTile& tile) {
    if (tile.borrows) {
        return;
    }
    seen.has_tiles = true;
    seen.local.add(tile.bounds);
    const scene::TileBuilder& builder = seen.node->stream->maker();
    const terrain::TileLattice lattice = builder.lattice(tile.id);
    const geo::WrappedRows rows = rows_of(*seen.node);
    const auto add = [&](glm::dvec2 sample, double height) {
        const glm::dvec2 at = builder.on_overview(sample);
        seen.samples.add(glm::dvec3(at.x, rows.even_row(at.y), height));
    };
    add(lattice.first, tile.range.low);
    add(lattice.last, tile.range.high);
}

// Where nothing is streamed; a plane has the same rays for all selections.
void add_surface(SeenTerrain& seen) {
    const scene::TerrainSurface& surface = *seen.node->surface;
    if (!seen.has_tiles || !is_curved(*seen.node)) {
        seen.local.add(surface.bounds());
        seen.samples.add(samples_and_heights(*seen.node));
    }
}

// All rays of a map, local.
ParallelRays parallel_rays(const view::DrawList& list, const glm::dmat4& local_from_world) {
    const auto ray_at = [&](glm::dvec2 part) {
        const Ray ray = scene::view_ray(list.camera, list.size, part * glm::dvec2(list.size));
        return Ray{glm::dvec3(local_from_world * glm::dvec4(ray.origin, 1.0)),
                   glm::dmat3(local_from_world) * ray.direction};
    };
    ParallelRays rays{ray_at(glm::dvec2(0.5))};
    for (const glm::dvec2 corner : {glm::dvec2(0.0), glm::dvec2(1.0)}) {
        rays.radius =
            std::max(rays.radius, glm::distance(ray_at(corner).origin, rays.middle.origin));
    }
    return rays;
}

// Whether a pole lies in the picture, or as far beside it as it is large.
bool shows_pole(const view::DrawList& list, const SeenTerrain& seen, double latitude) {
    const auto local = seen.node->surface->placement().world_from_geodetic({latitude, 0.0, 0.0});
    if (!local) {
        return false;
    }
    const glm::dvec3 world(seen.world_from_local * glm::dvec4(*local, 1.0));
    const scene::Projected projected = scene::project(list.camera, list.size, world);
    const glm::dvec2 size(list.size);
    return (projected.depth > 0.0 ||
            list.camera.projection == scene::ProjectionKind::orthographic) &&
           glm::all(glm::greaterThan(projected.pixel, -size)) &&
           glm::all(glm::lessThan(projected.pixel, 2.0 * size));
}

void leave_out_far_side(const view::DrawList& list, SeenTerrain& seen) {
    const terrain::Placement& placement = seen.node->surface->placement();
    seen.columns_around = *placement.columns_all_around();
    const glm::dmat4 local_from_world = glm::inverse(seen.world_from_local);
    const geo::WrappedRows rows = rows_of(*seen.node);
    const auto part =
        list.camera.projection == scene::ProjectionKind::perspective
            ? globe_part_from(glm::dvec3(local_from_world * glm::dvec4(list.camera.eye, 1.0)),
                              placement, rows, seen.samples)
            : globe_part_along(parallel_rays(list, local_from_world), placement, rows,
                               seen.samples);
    seen.is_from_below = !part;
    if (part) {
        seen.local = part->local;
        seen.samples = part->samples;
        seen.has_pole = (part->has_north_pole && shows_pole(list, seen, 90.0)) ||
                        (part->has_south_pole && shows_pole(list, seen, -90.0));
    }
}

// The rows of a terrain in memory whose tiles are drawn. Tiles that are left out are not seen.
void leave_out_unseen_rows(const view::DrawList& list, SeenTerrain& seen) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const view::TileDraw& draw : list.tiles) {
        if (draw.terrain == seen.node && draw.tile->borrows) {
            low = std::min(low, static_cast<double>(draw.tile->first.y));
            high = std::max(high, static_cast<double>(draw.tile->first.y + draw.tile->cells.y));
        }
    }
    if (low < high) {
        const geo::WrappedRows rows = rows_of(*seen.node);
        seen.samples.low.y = std::max(seen.samples.low.y, rows.even_row(low));
        seen.samples.high.y = std::min(seen.samples.high.y, rows.even_row(high));
    }
}

void find_part_of_globe(const view::DrawList& list, SeenTerrain& seen) {
    if (!is_curved(*seen.node) || !seen.node->surface->placement().columns_all_around()) {
        return;
    }
    if (!seen.has_tiles) {
        leave_out_unseen_rows(list, seen);
    }
    leave_out_far_side(list, seen);
}

} // namespace

std::vector<const scene::TerrainTile*> tiles_in(const view::DrawList& list,
                                                const scene::TerrainNode& terrain) {
    std::vector<const scene::TerrainTile*> tiles;
    const auto add = [&](const scene::TerrainTile& tile) {
        if (!tile.borrows) {
            tiles.push_back(&tile);
        }
    };
    for (const view::TerrainDraw* const draw : view::searched_terrains(list)) {
        if (draw->terrain == &terrain) {
            std::for_each(draw->search->tiles.begin(), draw->search->tiles.end(),
                          [&](const auto& tile) { add(*tile); });
        }
    }
    for (const view::TileDraw& draw : list.tiles) {
        if (draw.terrain == &terrain) {
            add(*draw.tile);
        }
    }
    return tiles;
}

std::vector<SeenTerrain> seen_terrains(const view::DrawList& list) {
    std::vector<SeenTerrain> seen;
    for (const view::TerrainDraw* const draw : view::searched_terrains(list)) {
        SeenTerrain& terrain = found_or_added(seen, draw->terrain, draw->world_from_local);
        for (const auto& tile : draw->search->tiles) {
            add_tile(terrain, *tile);
        }
    }
    for (const view::TileDraw& draw : list.tiles) {
        add_tile(found_or_added(seen, draw.terrain, list.world_from_local(draw)), *draw.tile);
    }
    for (SeenTerrain& terrain : seen) {
        add_surface(terrain);
        find_part_of_globe(list, terrain);
    }
    return seen;
}

std::optional<double> kept_error(const view::DrawList& list, double of_rays) {
    std::optional<double> largest;
    if (list.tiles.empty()) {
        largest = 0.0; // the samples
    }
    for (const view::TileDraw& draw : list.tiles) {
        if (draw.is_proven()) {
            largest = std::max(largest.value_or(0.0), draw.tile->borrows ? 0.0 : draw.error);
        }
    }
    return largest ? std::optional(*largest + of_rays) : largest;
}

geo::WrappedRows rows_of(const scene::TerrainNode& node) {
    return is_curved(node) ? node.surface->heightfield().georeference->geodetic.rows()
                           : geo::WrappedRows();
}

bool is_curved(const scene::TerrainNode& node) {
    return node.surface->placement().kind() == terrain::PlacementKind::ellipsoid;
}

std::array<glm::dvec3, 8> corners_of(const Box& box) {
    std::array<glm::dvec3, 8> corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        corners[i] = {(i & 1U) != 0 ? box.high.x : box.low.x,
                      (i & 2U) != 0 ? box.high.y : box.low.y,
                      (i & 4U) != 0 ? box.high.z : box.low.z};
    }
    return corners;
}

PixelBlock seen_pixels(const glm::dmat4& clip_from_local, glm::ivec2 size,
                       const std::array<glm::dvec3, 8>& corners) {
    glm::dvec2 low(std::numeric_limits<double>::infinity());
    glm::dvec2 high = -low;
    for (const glm::dvec3& corner : corners) {
        const glm::dvec4 clip = clip_from_local * glm::dvec4(corner, 1.0);
        if (!(clip.w > 0.0)) {
            return {{0, 0}, size}; // reaches behind the eye
        }
        const glm::dvec2 pixel =
            (0.5 + glm::dvec2(0.5, -0.5) * glm::dvec2(clip) / clip.w) * glm::dvec2(size);
        low = glm::min(low, pixel);
        high = glm::max(high, pixel);
    }
    constexpr double margin = 1.0; // floats of rays are off by far less
    const glm::dvec2 end(size);
    const glm::ivec2 first(glm::floor(glm::clamp(low - margin, glm::dvec2(0.0), end)));
    const glm::ivec2 last(glm::ceil(glm::clamp(high + margin, glm::dvec2(0.0), end)));
    return {first, last - first};
}

} // namespace reljef::cast
