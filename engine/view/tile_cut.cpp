#include "engine/view/tile_cut.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/core/parallel_for.h"
#include "engine/scene/tile_stream.h"
#include "engine/terrain/mesh/bisection.h"
#include "engine/terrain/mesh/patch_mesh.h"
#include "engine/view/error_view.h"

namespace reljef::view {
namespace {

constexpr double min_share_of_triangles = 0.5; // of the error bound

// The largest errors of vertices and of triangles are seldom at the same place. This power lies
// between their sum (1) and independent errors (2). Measured: over the Alps from far above, 2 makes
// the 99th percentile of the error a quarter larger.
constexpr double addition_power = 1.25;

// The triangles' share of the error bound.
double share_beside(double share_of_vertices) {
    const double taken = std::pow(std::min(share_of_vertices, 1.0), addition_power);
    return std::max(std::pow(1.0 - taken, 1.0 / addition_power), min_share_of_triangles);
}

// The plane that touches the tile: east, north and up, and the middle of the tile's corners.
glm::dmat4 plane_of(const scene::TerrainTile& tile) {
    const glm::dvec3 north_west = tile.place({0, 0});
    const glm::dvec3 north_east = tile.place({tile.cells.x, 0});
    const glm::dvec3 south_west = tile.place({0, tile.cells.y});
    const glm::dvec3 south_east = tile.place(tile.cells);
    const glm::dvec3 up(tile.up);
    const glm::dvec3 along = north_east - north_west + south_east - south_west;
    const glm::dvec3 east = glm::normalize(along - up * glm::dot(along, up));
    const glm::dvec3 middle = 0.25 * (north_west + north_east + south_west + south_east);
    return {glm::dvec4(east, 0.0), glm::dvec4(glm::cross(up, east), 0.0), glm::dvec4(up, 0.0),
            glm::dvec4(middle, 1.0)};
}

terrain::Heightfield heights_over(const glm::dmat4& local_from_plane,
                                  const scene::TerrainTile& tile) {
    const glm::dmat4 plane_from_local = glm::inverse(local_from_plane);
    const auto at = [&](glm::ivec2 vertex) {
        return glm::dvec3(plane_from_local * glm::dvec4(tile.place(vertex), 1.0));
    };
    terrain::Heightfield heightfield;
    heightfield.heights = Grid<float>(tile.cells.x + 1, tile.cells.y + 1);
    for (int row = 0; row <= tile.cells.y; ++row) {
        for (int col = 0; col <= tile.cells.x; ++col) {
            heightfield.heights(col, row) = static_cast<float>(at({col, row}).z);
        }
    }
    heightfield.range = terrain::height_range(heightfield.heights, {});
    const glm::dvec2 diagonal(at({tile.cells.x, 0}) - at({0, tile.cells.y}));
    heightfield.spacing = glm::abs(diagonal) / glm::dvec2(tile.cells);
    return heightfield;
}

} // namespace

// A loaded tile as heights over the plane that touches it, with their bisection. The error of its
// triangles includes the curvature of the Earth.
struct TileShape {
    explicit TileShape(const scene::TerrainTile& tile)
        : local_from_plane(plane_of(tile)), heightfield(heights_over(local_from_plane, tile)),
          placement(terrain::Placement::create(heightfield, terrain::PlacementKind::plane).value()),
          bisection(heightfield, placement, {.threads = 1, .stop = {}, .progress = {}}) {}
    TileShape(const TileShape&) = delete;

    glm::dmat4 local_from_plane{1.0};
    terrain::Heightfield heightfield;
    terrain::Placement placement;
    terrain::Bisection bisection;
};

namespace {

// As few triangles as the view and the splits allow.
terrain::Triangulation triangles_of(const TileShape& shape, const terrain::ErrorView& view,
                                    const Grid<std::uint8_t>& splits) {
    const Grid<float>& heights = shape.heightfield.heights;
    const terrain::Tile tile{0, 0, heights.cols() - 1, heights.rows() - 1, {}};
    return terrain::triangulate_samples(shape.bisection, tile, view, splits);
}

std::vector<std::vector<GridVertex>> vertices_of(const std::vector<terrain::Triangulation>& parts,
                                                 const scene::TerrainSurface& surface,
                                                 const terrain::Tile& tile, const CutMesh& last) {
    VertexPlacer placer(surface.heightfield(), surface.placement(), tile);
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

// Finds the triangles of all tiles of a cover.
class CoverCutter {
public:
    CoverCutter(const DrawList& list, const terrain::DrawnTiles& cover, std::span<TileToCut> tiles)
        : list_(list), cover_(cover), tiles_(tiles), views_(tiles.size()) {
        for (const TileToCut& tile : tiles_) {
            draws_.emplace(tile.draw->tile->id, tile.draw);
        }
    }

    void cut(bool is_new_cover) {
        make_shapes();
        for (std::size_t i = 0; i < tiles_.size(); ++i) {
            views_[i] = view_of(*tiles_[i].draw, *tiles_[i].cut->shape);
            is_new_cover = is_new_cover || tiles_[i].cut->view != views_[i];
        }
        if (is_new_cover && !tiles_.empty()) {
            find_triangles();
        }
    }

private:
    template <class Body> void for_each_tile(const Body& body) const {
        parallel_for(static_cast<int>(tiles_.size()),
                     [&](int i) { body(static_cast<std::size_t>(i)); });
    }

    void make_shapes() {
        const auto lacks_shape = [](const TileToCut& tile) { return tile.cut->shape == nullptr; };
        if (std::none_of(tiles_.begin(), tiles_.end(), lacks_shape)) {
            return; // starts no threads
        }
        for_each_tile([&](std::size_t i) {
            if (lacks_shape(tiles_[i])) {
                tiles_[i].cut->shape = std::make_shared<TileShape>(*tiles_[i].draw->tile);
            }
        });
    }

    void find_triangles() {
        const terrain::TileTree& tree = tiles_.front().draw->terrain->stream->tree();
        terrain::SharedSplits splits = terrain::shared_splits(tree, cover_, required());
        for_each_tile([&](std::size_t i) {
            TileToCut& tile = tiles_[i];
            Grid<std::uint8_t>& needed = splits.at(tile.draw->tile->id);
            if (tile.cut->view != views_[i] || tile.cut->splits != needed) {
                tile.triangles = triangles_of(*tile.cut->shape, views_[i], needed);
                tile.view = views_[i];
                tile.cut->view.reset();
                tile.cut->splits = std::move(needed);
            }
        });
    }

    [[nodiscard]] terrain::BorderSplits required() const {
        std::vector<std::vector<glm::ivec2>> found(tiles_.size());
        for_each_tile([&](std::size_t i) {
            found[i] = terrain::border_splits(tiles_[i].cut->shape->bisection, views_[i]);
        });
        terrain::BorderSplits required;
        for (std::size_t i = 0; i < tiles_.size(); ++i) {
            required.emplace(tiles_[i].draw->tile->id, std::move(found[i]));
        }
        return required;
    }

    [[nodiscard]] terrain::ErrorView view_of(const TileDraw& draw, const TileShape& shape) const {
        const double error = scene::error_bound(draw.terrain->material.technique);
        const double own_error = error * share_beside(error_of_vertices(draw) / error);
        return error_view(list_.camera, list_.size,
                          list_.world_from_local(draw) * shape.local_from_plane,
                          terrain::PlacementKind::plane, std::max(own_error, min_error));
    }

    // On a border those of the coarser tile.
    [[nodiscard]] double error_of_vertices(const TileDraw& draw) const {
        double max_drawn_error = draw.error;
        for (const terrain::TreeTile other : cover_.touching(draw.tile->id)) {
            max_drawn_error = std::max(max_drawn_error, draws_.at(other)->error);
        }
        return max_drawn_error;
    }

    const DrawList& list_;
    const terrain::DrawnTiles& cover_;
    std::span<TileToCut> tiles_;
    std::vector<terrain::ErrorView> views_;
    std::map<terrain::TreeTile, const TileDraw*> draws_;
};

} // namespace

CutMesh cut_alone(const terrain::Bisection* bisection, const Coarseness& coarseness,
                  const scene::TerrainSurface& surface, const terrain::Tile& tile,
                  const CutMesh& last) {
    CutMesh cut;
    if (const auto* view = std::get_if<terrain::ErrorView>(&coarseness)) {
        cut.parts = terrain::triangulate(*bisection, tile, *view);
    } else {
        cut.parts = {terrain::triangulate_patches(std::get<Grid<std::uint8_t>>(coarseness), tile)};
    }
    if (cut.parts != last.parts) {
        cut.vertices = vertices_of(cut.parts, surface, tile, last);
    }
    return cut;
}

void cut_together(const DrawList& list, const terrain::DrawnTiles& cover, bool is_new_cover,
                  std::span<TileToCut> tiles) {
    CoverCutter(list, cover, tiles).cut(is_new_cover);
}

} // namespace reljef::view
