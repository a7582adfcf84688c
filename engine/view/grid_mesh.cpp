#include "engine/view/grid_mesh.h"

#include "engine/core/geometry.h"

namespace reljef::view {
namespace {

// On a tile of 12 km (128 samples, 3″ apart) the chord of an eighth stays within 5 cm of the arc.
constexpr int flat_ellipsoid_quads = 8;

// Samples of the terrain from the tile's first. Between vertices, places are linear.
glm::dvec2 place_in_tile(const terrain::Placement& placement, const terrain::TileCells& tile,
                         glm::dvec2 sample) {
    return placement.on_even_rows(sample) - placement.on_terrain(glm::dvec2(tile.first));
}

template <class HeightAt>
GridMesh grid_mesh(const terrain::Placement& placement, const terrain::TileCells& tile,
                   glm::ivec2 quads, const HeightAt& height_at) {
    GridMesh mesh{quads.x, quads.y, {}};
    mesh.vertices.reserve(static_cast<std::size_t>(quads.x + 1) *
                          static_cast<std::size_t>(quads.y + 1));
    const glm::dvec2 step = glm::dvec2(tile.count) / glm::dvec2(quads);
    for (int row = 0; row <= quads.y; ++row) {
        for (int col = 0; col <= quads.x; ++col) {
            const glm::dvec2 sample{tile.first.x + col * step.x, tile.first.y + row * step.y};
            const double height = height_at(sample);
            mesh.vertices.push_back(grid_vertex(placement.world_from_sample({sample, height}),
                                                height, place_in_tile(placement, tile, sample)));
        }
    }
    return mesh;
}

} // namespace

GridVertex grid_vertex(glm::dvec3 local, double height, glm::dvec2 place) {
    const SplitPoint position = split_into_floats(local);
    return {position.rounded, static_cast<float>(height), glm::vec2(place), position.rest};
}

GridMesh full_mesh(const terrain::Heightfield& heightfield, const terrain::Placement& placement,
                   const terrain::TileCells& tile) {
    return grid_mesh(placement, tile, tile.count, [&](glm::dvec2 sample) {
        return static_cast<double>(
            heightfield.heights(static_cast<int>(sample.x), static_cast<int>(sample.y)));
    });
}

void VertexPlacer::know(const terrain::Triangulation& part, std::span<const GridVertex> vertices) {
    check(vertices.size() == part.vertices.size(), "a triangulation and the vertices of another");
    if (!part.moves.empty()) {
        return; // morphing
    }
    if (at_samples_.empty()) {
        at_samples_ = Grid<const GridVertex*>(tile_.count.x + 1, tile_.count.y + 1, nullptr);
    }
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const glm::ivec2 sample = terrain::sample_before(part.vertices[i]);
        if (terrain::steps_of(sample) == part.vertices[i]) {
            at_samples_(sample.x - tile_.first.x, sample.y - tile_.first.y) = &vertices[i];
        }
    }
}

const GridVertex* VertexPlacer::known(terrain::Steps steps) const {
    const glm::ivec2 sample = terrain::sample_before(steps);
    return at_samples_.empty() || terrain::steps_of(sample) != steps
               ? nullptr
               : at_samples_(sample.x - tile_.first.x, sample.y - tile_.first.y);
}

GridVertex VertexPlacer::placed(terrain::Steps steps, const terrain::VertexMove& move) const {
    const glm::dvec2 sample = terrain::samples_of(steps);
    const double height = terrain::bilinear_height(heightfield_.heights.view(), sample);
    return grid_vertex(placement_.world_from_sample({sample, height}) + move.offset,
                       height + move.height, place_in_tile(placement_, tile_, sample));
}

std::vector<GridVertex> VertexPlacer::place(const terrain::Triangulation& part) const {
    std::vector<GridVertex> vertices;
    vertices.reserve(part.vertices.size());
    for (std::size_t i = 0; i < part.vertices.size(); ++i) {
        const terrain::VertexMove move = part.moves.empty() ? terrain::VertexMove{} : part.moves[i];
        const GridVertex* const there = part.moves.empty() ? known(part.vertices[i]) : nullptr;
        vertices.push_back(there != nullptr ? *there : placed(part.vertices[i], move));
    }
    return vertices;
}

glm::ivec2 flat_quads(const terrain::Placement& placement, glm::ivec2 cells) {
    return placement.kind() == terrain::PlacementKind::plane ? glm::ivec2(1)
           : placement.lattice() != nullptr                  ? cells
                                                             : glm::ivec2(flat_ellipsoid_quads);
}

GridMesh flat_mesh(const terrain::Placement& placement, const terrain::TileCells& tile,
                   double height) {
    const glm::ivec2 quads = flat_quads(placement, tile.count);
    return grid_mesh(placement, tile, quads, [&](glm::dvec2) { return height; });
}

} // namespace reljef::view
