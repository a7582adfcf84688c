#include "engine/cast/frame/sun_light.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <set>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
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

// To the sun of a list, local.
std::optional<glm::dvec3> local_to_sun(const view::DrawList& list, const SeenTerrain& seen) {
    const auto light = view::light_on(list, seen.world_from_local);
    return light
               ? std::optional(glm::inverse(light->world_from_local) * scene::to_light(light->sun))
               : std::nullopt;
}

// The same in samples of a terrain on a plane, or of its stream.
glm::dvec3 in_samples_of(const SeenTerrain& seen, glm::dvec3 local) {
    const scene::TerrainNode& node = *seen.node;
    glm::dvec3 to_sun = direction_in_samples(node.surface->placement(), local);
    if (seen.has_tiles) {
        to_sun *= glm::dvec3(glm::dvec2(node.stream->maker().reduction()), 1.0);
    }
    return to_sun;
}

// In samples of the terrain's surface.
Box tile_box(const scene::TileBuilder& builder, const scene::TerrainTile& tile) {
    const terrain::TileLattice lattice = builder.lattice(tile.id);
    Box box;
    box.add(glm::dvec3(builder.on_overview(lattice.first), tile.range.low));
    box.add(glm::dvec3(builder.on_overview(lattice.last), tile.range.high));
    return box;
}

// Those above others.
std::set<terrain::TreeTile> parents_of(std::span<const scene::TerrainTile* const> tiles,
                                       int top_level) {
    std::set<terrain::TreeTile> parents;
    for (const scene::TerrainTile* const tile : tiles) {
        terrain::TreeTile id = tile->id;
        while (id.level < top_level) {
            id = {id.level + 1, id.col / 2, id.row / 2};
            parents.insert(id);
        }
    }
    return parents;
}

// Rays begin on the finest tiles. All loaded ones above them, and the overview, may hide the sun.
SunCourse::Ground ground_of(const view::DrawList& list, const SeenTerrain& seen) {
    if (!seen.has_tiles) {
        return {seen.samples, seen.samples};
    }
    const scene::TileStream& stream = *seen.node->stream;
    const std::vector<const scene::TerrainTile*> tiles = tiles_in(list, *seen.node);
    const auto parents = parents_of(tiles, stream.tree().root().level);
    const Grid<float>& overview = seen.node->surface->heightfield().heights;
    const terrain::MinMax total = seen.node->surface->pyramid().total();
    SunCourse::Ground ground;
    ground.all.add(glm::dvec3(0.0, 0.0, total.low));
    ground.all.add(glm::dvec3(overview.cols() - 1.0, overview.rows() - 1.0, total.high));
    for (const scene::TerrainTile* const tile : tiles) {
        if (!parents.contains(tile->id)) {
            ground.lit.add(tile_box(stream.maker(), *tile));
        }
    }
    ground.all.add(ground.lit);
    for (const terrain::TreeTile id : parents) {
        if (const auto tile = stream.find(id)) {
            ground.all.add(tile_box(stream.maker(), *tile));
        }
    }
    return ground;
}

std::shared_ptr<const SunCourse> course_to(glm::dvec3 local, const SeenTerrain& seen,
                                           const SunCourse::Ground& ground) {
    auto course = SunCourse::create(seen.node->surface->placement(), glm::normalize(local), ground);
    return course ? std::make_shared<const SunCourse>(std::move(*course)) : nullptr;
}

// In samples of the terrain's surface.
std::vector<SunSource> on_surface(const SeenTerrain& seen, std::vector<SunSource> sources) {
    for (SunSource& source : sources) {
        const scene::TileBuilder& builder = seen.node->stream->maker();
        source.first = builder.on_overview(source.first);
        source.step /= static_cast<double>(builder.reduction());
    }
    return sources;
}

// A world place in the samples of a terrain; on a plane of its stream, if it has tiles.
std::optional<glm::dvec3> sample_of(const SeenTerrain& seen, const glm::dmat4& local_from_world,
                                    glm::dvec3 world) {
    const scene::TerrainNode& node = *seen.node;
    const glm::dvec3 local(local_from_world * glm::dvec4(world, 1.0));
    const auto sample = node.surface->placement().sample_from_world(local);
    return sample && seen.has_tiles && !is_curved(node)
               ? glm::dvec3(node.stream->maker().from_overview(glm::dvec2(*sample)), sample->z)
               : sample;
}

} // namespace

bool casts_shadows(const SeenTerrain& seen) {
    return seen.node->material.technique.options.shadow.has_value();
}

std::vector<std::shared_ptr<const scene::TerrainTile>> tiles_above(const view::DrawList& list) {
    std::vector<std::shared_ptr<const scene::TerrainTile>> above;
    for (const SeenTerrain& seen : seen_terrains(list)) {
        if (!seen.has_tiles || !casts_shadows(seen) || !is_curved(*seen.node)) {
            continue;
        }
        const scene::TileStream& stream = *seen.node->stream;
        for (const terrain::TreeTile id :
             parents_of(tiles_in(list, *seen.node), stream.tree().root().level)) {
            if (auto tile = stream.find(id)) {
                above.push_back(std::move(tile));
            }
        }
    }
    return above;
}

bool bends_too_much(const view::DrawList& list, const SeenTerrain& seen) {
    const auto local = local_to_sun(list, seen);
    return local && local->z > 0.0 && course_to(*local, seen, ground_of(list, seen)) == nullptr;
}

void add_sun(const view::DrawList& list, const SeenTerrain& seen, std::vector<SunSource> beside,
             PlacedTiles& placed) {
    const auto local = local_to_sun(list, seen);
    if (!local || local->z <= 0.0) {
        return; // there is no such light
    }
    if (!is_curved(*seen.node)) {
        add_sun_tiles(placed, beside, {in_samples_of(seen, *local)});
    } else if (auto course = course_to(*local, seen, ground_of(list, seen))) {
        add_sun_tiles(placed, on_surface(seen, std::move(beside)), {{}, std::move(course)});
    }
}

std::optional<ShadowGround> shadow_ground(const view::DrawList& list, const SeenTerrain& seen,
                                          const PlacedTiles& placed,
                                          std::vector<SunSource> beside) {
    const auto local = casts_shadows(seen) ? local_to_sun(list, seen) : std::nullopt;
    if (!local) {
        return std::nullopt;
    }
    ShadowGround ground;
    if (is_curved(*seen.node)) {
        ground.sources = on_surface(seen, std::move(beside));
        ground.sun.bent = placed.sun_course;
    } else {
        ground.sources = std::move(beside);
        ground.sun.straight = in_samples_of(seen, *local);
    }
    const std::vector<SunSource> sources = sun_sources(placed);
    ground.sources.insert(ground.sources.end(), sources.begin(), sources.end());
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
