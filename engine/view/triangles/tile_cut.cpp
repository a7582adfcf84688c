#include "engine/view/triangles/tile_cut.h"

#include <algorithm>
#include <utility>
#include <variant>

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

constexpr double larger_than_pictures = 1 << 17; // pixels
constexpr int first_min_size = 4;                // steps
constexpr int max_min_size = terrain::steps_per_sample * terrain::tree_tile_cells;

} // namespace

bool is_coarsest(const Coarsening& coarsening) {
    return coarsening.min_error > larger_than_pictures || coarsening.min_size > max_min_size;
}

// First all triangles get larger errors. That helps little where cliffs may reach the eye: there
// they are split whatever the error. Then the smallest triangles get larger.
Coarsening coarser(const terrain::ErrorView& view, const Coarsening& coarsening) {
    constexpr double max_bounds = 16.0; // in perspective
    if (coarsening.min_size > 0) {
        const int growth = coarsening.min_size < terrain::steps_per_sample / 64 ? 8 : 2;
        return {view.max_error, growth * coarsening.min_size};
    }
    const double min_error = std::max(2.0 * coarsening.min_error, view.max_error);
    return view.perspective && min_error > max_bounds * view.max_error
               ? Coarsening{view.max_error, first_min_size}
               : Coarsening{min_error, 0};
}

TileSurface surface_of(const TileDraw& draw) {
    const scene::TerrainTile& tile = *draw.tile;
    const scene::TerrainSurface& surface = *draw.terrain->surface;
    return {tile.borrows ? surface.heightfield() : tile.heightfield,
            tile.borrows ? surface.placement() : *tile.placement,
            {tile.first, tile.cells}};
}

terrain::ErrorView triangle_view(const terrain::ErrorView& bound, const CutOptions& options) {
    terrain::ErrorView view = bound;
    view.max_error = std::max(options.triangle_error, options.coarsening.min_error);
    view.min_size = options.coarsening.min_size;
    return view;
}

CutMesh cut_tile(const Coarseness& coarseness, const TileSurface& surface,
                 const CutOptions& options, const CutMesh& last) {
    CutMesh cut;
    if (const auto* bound = std::get_if<terrain::ErrorView>(&coarseness)) {
        const terrain::ErrorView view = triangle_view(*bound, options);
        terrain::TileTriangles triangles =
            terrain::triangulate(*options.bisection, surface.samples, view, options.budget);
        if (options.budget != nullptr && options.budget->is_exceeded()) {
            return {};
        }
        cut.parts = std::move(triangles.parts);
        cut.error = options.error + triangles.error + view.vertex_rounding + rasterizer_error;
    } else {
        cut.parts = {terrain::triangulate_patches(std::get<Grid<std::uint8_t>>(coarseness),
                                                  surface.samples)};
    }
    if (cut.parts == last.parts) {
        return {{}, {}, cut.error};
    }
    cut.vertices = vertices_of(cut.parts, surface, last);
    return cut;
}

} // namespace reljef::view
