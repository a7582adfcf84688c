#include "engine/render/streamed_cut.h"

#include <algorithm>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/render/error_view.h"
#include "engine/terrain/bisection.h"
#include "engine/terrain/kept_border.h"

namespace reljef::render {
namespace {

constexpr double share_of_triangles = 0.5; // of the error

glm::dvec3 place_of(const scene::StreamedTile& tile, glm::ivec2 vertex) {
    return tile.place(vertex);
}

// East, north and up of the plane, and the middle of the tile's corners.
glm::dmat4 plane_of(const scene::StreamedTile& tile) {
    const glm::dvec3 north_west = place_of(tile, {0, 0});
    const glm::dvec3 north_east = place_of(tile, {tile.cells.x, 0});
    const glm::dvec3 south_west = place_of(tile, {0, tile.cells.y});
    const glm::dvec3 south_east = place_of(tile, tile.cells);
    const glm::dvec3 up(tile.up);
    const glm::dvec3 along = north_east - north_west + south_east - south_west;
    const glm::dvec3 east = glm::normalize(along - up * glm::dot(along, up));
    const glm::dvec3 middle = 0.25 * (north_west + north_east + south_west + south_east);
    return {glm::dvec4(east, 0.0), glm::dvec4(glm::cross(up, east), 0.0), glm::dvec4(up, 0.0),
            glm::dvec4(middle, 1.0)};
}

terrain::Heightfield heights_over(const glm::dmat4& local_from_plane,
                                  const scene::StreamedTile& tile) {
    const glm::dmat4 plane_from_local = glm::inverse(local_from_plane);
    const auto at = [&](glm::ivec2 vertex) {
        return glm::dvec3(plane_from_local * glm::dvec4(place_of(tile, vertex), 1.0));
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

struct StreamedShape::Data {
    explicit Data(terrain::Heightfield made)
        : heightfield(std::move(made)),
          placement(terrain::Placement::create(heightfield, terrain::PlacementKind::plane).value()),
          bisection(heightfield, placement, {.threads = 1, .stop = {}, .progress = {}}) {}

    terrain::Heightfield heightfield;
    terrain::Placement placement;
    terrain::Bisection bisection;
};

StreamedShape::StreamedShape(const scene::StreamedTile& tile)
    : local_from_plane_(plane_of(tile)),
      data_(std::make_unique<const Data>(heights_over(local_from_plane_, tile))) {}
StreamedShape::~StreamedShape() = default;
StreamedShape::StreamedShape(StreamedShape&&) noexcept = default;
StreamedShape& StreamedShape::operator=(StreamedShape&&) noexcept = default;

std::vector<std::uint16_t> StreamedShape::triangles(const terrain::ErrorView& view) const {
    const Grid<float>& heights = data_->heightfield.heights;
    const glm::ivec2 cells(heights.cols() - 1, heights.rows() - 1);
    const terrain::Tile tile{0, 0, cells.x, cells.y, {}};
    const terrain::Triangulation cut = terrain::triangulate_samples(
        data_->bisection, tile, view, terrain::splits_of_border(cells));
    std::vector<std::uint16_t> indices;
    indices.reserve(cut.indices.size());
    for (const std::uint16_t index : cut.indices) {
        const glm::ivec2 vertex = cut.vertices[index] / terrain::steps_per_sample;
        indices.push_back(static_cast<std::uint16_t>(vertex.y * heights.cols() + vertex.x));
    }
    return indices;
}

bool is_cut(const StreamedDraw& draw) {
    const scene::Technique& technique = draw.terrain->material.technique;
    return !draw.flat && technique.id == scene::TechniqueId::polygons &&
           scene::parameter(technique, "error") > 0.0;
}

terrain::ErrorView cut_view(const DrawList& list, const StreamedDraw& draw,
                            const StreamedShape& shape) {
    const double error = scene::parameter(draw.terrain->material.technique, "error");
    return error_view(list.camera, list.size, draw.world_from_local * shape.local_from_plane(),
                      terrain::PlacementKind::plane,
                      std::max(share_of_triangles * error, least_error));
}

} // namespace reljef::render
