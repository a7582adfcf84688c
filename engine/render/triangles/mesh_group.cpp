#include "engine/render/triangles/mesh_group.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace reljef::render {
namespace {

// Of the tile's vertices, pixels. What is hidden by nearer ground shows where the triangles of that
// ground are off by more than the bound.
double tile_error(const view::TileDraw& draw, const MeshGroup& group) {
    const auto* const bound = std::get_if<terrain::ErrorView>(&group.coarseness);
    const bool is_beyond = bound != nullptr && (group.coarsening.min_size > 0 ||
                                                group.coarsening.min_error > bound->max_error ||
                                                bound->exceeded_by_rounding);
    return is_beyond ? std::max(draw.error, draw.error_with_hidden) : draw.error;
}

} // namespace

bool ResidentTriangles::is_held_elsewhere() const {
    return owner.use_count() > (bisection != nullptr ? 1 : 0);
}

const terrain::Bisection&
ResidentTriangles::own_bisection(const std::shared_ptr<const scene::TerrainTile>& tile) {
    if (bisection == nullptr) {
        bisection = std::make_unique<const TileBisection>(tile);
    }
    return bisection->bisection;
}

void MeshGroup::replace_meshes(ResidentTriangles& tile, std::vector<TileMesh> meshes) {
    std::move(tile.meshes.end() - static_cast<std::ptrdiff_t>(tile.seam_count), tile.meshes.end(),
              std::back_inserter(meshes));
    tile.meshes = std::move(meshes);
    tile.shape = ++last_shape;
    tile.slivers_version = 0;
}

bool has_seams(const view::TileDraw& draw) {
    return !draw.tile->borrows && !draw.flat;
}

view::CutOptions cut_options(const MeshGroup& group, const OutdatedTile& tile,
                             const terrain::Bisection* shared) {
    const auto& [draw, triangles] = tile;
    const bool has_own =
        shared == nullptr && std::holds_alternative<terrain::ErrorView>(group.coarseness);
    return {has_own ? &triangles->own_bisection(draw->tile) : shared, tile_error(*draw, group),
            draw->triangle_error, group.coarsening, nullptr};
}

} // namespace reljef::render
