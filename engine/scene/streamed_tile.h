#pragma once

#include <cstddef>
#include <memory>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/color.h"
#include "engine/core/geometry.h"
#include "engine/core/grid.h"
#include "engine/scene/terrain_light.h"
#include "engine/scene/terrain_node.h"
#include "engine/terrain/tile_tree.h"
#include "engine/terrain/tint.h"

namespace reljef::scene {

/// A tile of a terrain that is read part by part, ready to be drawn.
struct StreamedTile {
    terrain::TreeTile id;
    glm::ivec2 cells{0};
    glm::dvec3 origin{0.0};    ///< local metres
    Grid<glm::vec3> positions; ///< of the vertices, metres from the origin
    Grid<float> heights;       ///< true metres
    Grid<glm::vec3> normals;   ///< unit, local frame
    glm::vec3 up{0.0F, 0.0F, 1.0F};
    Image albedo; ///< a texel a vertex, sRGB
    Box bounds;   ///< local metres
    terrain::HeightRange range;
    /// Metres that the next finer level is about to move the surface: as far as every second vertex
    /// of this one is from the middle between its neighbours. An estimate: finer detail is smaller
    /// than coarser on natural ground.
    double error = 0.0;

    /// What it takes, drawn, bytes.
    [[nodiscard]] std::size_t bytes() const;
};

/// Memory of a tile of full size, drawn: here and with the driver, bytes.
inline constexpr std::size_t bytes_of_bisection = 40; // a vertex, where triangles are chosen
inline constexpr std::size_t bytes_per_vertex =
    2 * sizeof(glm::vec3) + sizeof(float) + sizeof(Rgba8) + 36 + 6 + bytes_of_bisection;
inline constexpr std::size_t bytes_per_tile =
    bytes_per_vertex * (terrain::tile_cells + 1) * (terrain::tile_cells + 1);

/// Makes tiles of a terrain from their samples. What an overview of the whole terrain knows holds
/// for them too: where they stand, the scale of colours, the draped picture, the sun's shadows.
/// Safe from several threads at a time.
class TileMaker {
public:
    /// `reduction`: samples of the tree's raster a side in one of the overview's, which lies in the
    /// middle of them.
    TileMaker(std::shared_ptr<const TerrainSurface> overview, terrain::TileTree tree,
              int reduction);

    [[nodiscard]] const terrain::TileTree& tree() const { return tree_; }
    [[nodiscard]] const TerrainSurface& overview() const { return *overview_; }
    /// Where a sample of the tree's raster lies on the overview.
    [[nodiscard]] glm::dvec2 on_overview(glm::dvec2 sample) const;
    [[nodiscard]] glm::dvec2 from_overview(glm::dvec2 sample) const;
    /// Metres from vertex to vertex at a level.
    [[nodiscard]] double spacing(int level) const;

    /// `heights`: metres at the vertices and one step around them, NaN where there is none: those
    /// voids are filled with what the overview has.
    [[nodiscard]] StreamedTile make(terrain::TreeTile tile, Grid<float> heights) const;
    /// The box of a tile whose heights are in `range`.
    [[nodiscard]] Box bounds(terrain::TreeTile tile, terrain::HeightRange range) const;
    /// Where a vertex stands at another height, local metres.
    [[nodiscard]] glm::dvec3 place(terrain::TreeTile tile, glm::ivec2 vertex, double height) const;

private:
    [[nodiscard]] Rgba8 color_at(glm::dvec2 overview_sample, float height) const;

    std::shared_ptr<const TerrainSurface> overview_;
    terrain::TileTree tree_;
    int reduction_;
    terrain::HeightTint tint_;
};

/// What a tile sends to the eye: its colour in the light, a texel a vertex, sRGB.
Image lit_tile(const TileMaker& maker, const StreamedTile& tile,
               const TerrainIrradiance& irradiance);

} // namespace reljef::scene
