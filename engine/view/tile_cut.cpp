#include "engine/view/tile_cut.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/scene/tile_stream.h"
#include "engine/terrain/mesh/bisection.h"
#include "engine/terrain/mesh/patch_mesh.h"
#include "engine/view/error_view.h"

namespace reljef::view {
namespace {

std::vector<std::vector<GridVertex>> vertices_of(const std::vector<terrain::Triangulation>& parts,
                                                 const TileSurface& surface, const CutMesh& last) {
    VertexPlacer placer(surface.heightfield, surface.placement, surface.samples);
    for (std::size_t i = 0; i < last.parts.size(); ++i) {
        placer.know(last.parts[i], last.vertices[i]);
    }
    std::vector<std::vector<GridVertex>> vertices;
    vertices.reserve(parts.size());
    for (const terrain::Triangulation& part : parts) {
        vertices.push_back(placer.place(part));
    }
    return vertices;
}

// The sine of the angle between an orthographic view and the vertical of a tile, at least an
// eighth: from above, an error is higher than it is wide.
double sine_of_view(const DrawList& list, const TileDraw& draw) {
    const glm::dvec3 up =
        glm::normalize(glm::dmat3(list.world_from_local(draw)) * glm::dvec3(draw.tile->up));
    return std::max(glm::length(glm::cross(scene::view_axes(list.camera).forward, up)), 1.0 / 8.0);
}

// The largest distance from the eye to a tile, metres.
double farthest(const DrawList& list, const TileDraw& draw) {
    const Box bounds = transformed(list.world_from_local(draw), draw.tile->bounds);
    const glm::dvec3 away =
        glm::max(glm::abs(list.camera.eye - bounds.low), glm::abs(list.camera.eye - bounds.high));
    return glm::length(away);
}

// The triangles of two neighbours are a bound off each, and rasterized.
constexpr double bounds_of_gaps = 3.0;

} // namespace

TileSurface surface_of(const TileDraw& draw) {
    const scene::TerrainTile& tile = *draw.tile;
    if (tile.borrows) {
        const scene::TerrainSurface& surface = *draw.terrain->surface;
        return {surface.heightfield(), surface.placement(), scene::samples_of(tile)};
    }
    return {tile.heightfield, *tile.placement, {0, 0, tile.cells.x, tile.cells.y, tile.bounds}};
}

terrain::Skirt skirt_of(const DrawList& list, const TileDraw& draw) {
    const scene::TerrainTile& tile = *draw.tile;
    if (tile.borrows) {
        return {};
    }
    const glm::dvec2 metres(metres_a_pixel(list.camera, list.size));
    const double bound = std::max(scene::error_bound(draw.terrain->material.technique), 1.0);
    const terrain::TileTree& tree = draw.terrain->stream->tree();
    const glm::ivec2 last = glm::ivec2(tree.cols(), tree.rows()) - 1;
    const glm::ivec2 first = terrain::TileTree::first(tile.id);
    const glm::ivec2 end = tree.sample(tile.id, tile.cells);
    const bool wraps = tree.wraps_longitude();
    terrain::Skirt skirt{.depth = draw.gap +
                                  bounds_of_gaps * bound * metres.x / sine_of_view(list, draw),
                         .north = first.y > 0,
                         .east = wraps || end.x < last.x,
                         .south = end.y < last.y,
                         .west = wraps || first.x > 0};
    if (draw.coarse) {
        skirt.slope = bounds_of_gaps * bound * metres.y;
        skirt.eye = glm::dvec3(glm::inverse(list.world_from_local(draw)) *
                               glm::dvec4(list.camera.eye, 1.0));
    } else { // seldom changes
        const double size = glm::length(draw.terrain->surface->bounds().size());
        skirt.depth += bounds_of_gaps * bound * metres.y * farthest(list, draw);
        skirt.depth = std::exp2(std::ceil(std::log2(std::min(skirt.depth, size))));
    }
    return skirt;
}

CutMesh cut_tile(const Coarseness& coarseness, const TileSurface& surface,
                 const CutOptions& options, const CutMesh& last) {
    CutMesh cut;
    if (const auto* bound = std::get_if<terrain::ErrorView>(&coarseness)) {
        terrain::ErrorView view = *bound;
        view.max_error = options.triangle_error;
        terrain::TileTriangles triangles =
            terrain::triangulate(*options.bisection, surface.samples, view);
        cut.parts = std::move(triangles.parts);
        cut.error = options.error + triangles.error + rasterizer_error;
    } else {
        cut.parts = {terrain::triangulate_patches(std::get<Grid<std::uint8_t>>(coarseness),
                                                  surface.samples)};
    }
    const terrain::Skirt& skirt = options.skirt;
    if (!skirt.is_empty()) {
        auto walls = terrain::skirt_below(cut.parts, surface.samples, surface.heightfield,
                                          surface.placement, skirt);
        std::move(walls.begin(), walls.end(), std::back_inserter(cut.parts));
    }
    if (cut.parts == last.parts) {
        return {{}, {}, cut.error};
    }
    cut.vertices = vertices_of(cut.parts, surface, last);
    return cut;
}

CutMesh whole_skirt(const TileSurface& surface, const terrain::Skirt& skirt) {
    CutMesh walls;
    if (!skirt.is_empty()) {
        walls.parts = terrain::skirt_below_samples(surface.samples, surface.heightfield,
                                                   surface.placement, skirt);
        walls.vertices = vertices_of(walls.parts, surface, {});
    }
    return walls;
}

} // namespace reljef::view
