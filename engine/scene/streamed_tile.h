#pragma once

#include <cstddef>
#include <memory>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/color.h"
#include "engine/core/geometry.h"
#include "engine/core/grid.h"
#include "engine/scene/graph/terrain_light.h"
#include "engine/scene/graph/terrain_node.h"
#include "engine/terrain/field/min_max_pyramid.h"
#include "engine/terrain/field/tint.h"
#include "engine/terrain/tree/tile_tree.h"

namespace reljef::scene {

/// What images show of a tile: texels edge to edge over its vertices, alpha 0 where they show
/// nothing; empty: none.
struct TilePicture {
    Image texels;
    bool whole = true;     ///< false: more may be shown than was read, the overview knows
    bool has_more = false; ///< finer texels are to be had
};

/// Cells along a side of the blocks that a streamed tile knows the range of.
inline constexpr int cells_per_block = 8;

/// What tiles are chosen by.
struct TileSummary {
    terrain::TreeTile id;
    Box bounds; ///< local metres
    terrain::HeightRange range;
    /// Metres that the next finer level is about to move the surface: as far as every second vertex
    /// of this one is from the middle between its neighbours. An estimate: finer detail is smaller
    /// than coarser on natural ground.
    double error = 0.0;
    /// Metres between texels where finer ones are to be had, else 0.
    double coarse_texel = 0.0;
};

/// A tile of a terrain that is read part by part, ready to be drawn.
struct StreamedTile : TileSummary {
    glm::ivec2 cells{0};
    glm::dvec3 origin{0.0};     ///< local metres
    double unit = 1.0;          ///< metres: at most 2^-30 of the bounds' longest side
    Grid<glm::ivec3> positions; ///< of the vertices, units from the origin: see place()
    Grid<float> heights;        ///< true metres
    Grid<glm::vec3> normals;    ///< unit, local frame
    glm::vec3 up{0.0F, 0.0F, 1.0F};
    Image albedo;                 ///< edge to edge over the vertices, at least a texel each, sRGB
    Grid<terrain::MinMax> blocks; ///< of cells_per_block cells a side; the last ones may be cut
    bool of_overview = false;     ///< the heights are TileBuilder::overview_heights

    /// Of a vertex, local metres, to half a unit: 4 µm where the tile is 12 km wide.
    [[nodiscard]] glm::dvec3 place(glm::ivec2 vertex) const {
        return origin + unit * glm::dvec3(positions(vertex.x, vertex.y));
    }
    /// Where a texel of the albedo lies, in vertices.
    [[nodiscard]] glm::dvec2 vertex_of(glm::ivec2 texel) const;
    /// At a place in vertices, unit.
    [[nodiscard]] glm::vec3 normal_at(glm::dvec2 vertex) const;

    /// What it takes, drawn, bytes.
    [[nodiscard]] std::size_t bytes() const;
};

/// Memory of a tile of full size, drawn: here and with the driver, bytes.
inline constexpr std::size_t bytes_of_bisection = 40; // a vertex, where triangles are chosen
inline constexpr std::size_t bytes_per_vertex =
    2 * sizeof(glm::vec3) + sizeof(float) + sizeof(Rgba8) + 36 + 6 + bytes_of_bisection;
inline constexpr std::size_t bytes_per_tile =
    bytes_per_vertex * (terrain::tile_cells + 1) * (terrain::tile_cells + 1);
/// Of a texel that is more than one a vertex: here, and with mipmaps at the driver's.
inline constexpr double bytes_per_texel = 4.0 + 16.0 / 3.0;

/// Texels from vertex to vertex, at most: tiles are chosen so fine that with them none is seen
/// larger than a pixel.
inline constexpr int max_texels_per_cell = 4;

/// Bytes of a drawn tile of full size with a picture of this many texels.
std::size_t bytes_of_tile(int texels_per_cell);

/// Images that tiles show.
struct ImageryDetail {
    double finest_pixel = 0.0; ///< metres; 0: none
    /// Samples of the tree's raster from sample to sample of the terrain's: more than 1 where
    /// images are so much finer that even its finest tiles would show them coarsely.
    int refinement = 1;
    int max_texels = max_texels_per_cell; ///< from vertex to vertex: fewer take less memory
};

/// Makes tiles of a terrain from their samples. What an overview of the whole terrain knows holds
/// for them too: where they stand, the scale of colours, the draped picture, the sun's shadows.
/// Safe from several threads at a time.
class TileBuilder {
public:
    /// `reduction`: samples of the terrain a side in one of the overview's, which lies in the
    /// middle of them. `closing`: of the tree's raster, where it goes all around the Earth.
    TileBuilder(std::shared_ptr<const TerrainSurface> overview, terrain::TileTree tree,
                int reduction, const ImageryDetail& imagery = {},
                const geo::GlobalWrap& closing = {});

    [[nodiscard]] const terrain::TileTree& tree() const { return tree_; }
    [[nodiscard]] const TerrainSurface& overview() const { return *overview_; }
    /// Samples of the terrain from vertex to vertex.
    [[nodiscard]] double step(terrain::TreeTile tile) const;
    /// The sample of the terrain where the tile begins, and where a vertex lies.
    [[nodiscard]] glm::dvec2 first(terrain::TreeTile tile) const;
    [[nodiscard]] glm::dvec2 sample(terrain::TreeTile tile, glm::ivec2 vertex) const;
    /// In the tree's raster.
    [[nodiscard]] glm::dvec2 tree_sample(glm::dvec2 sample) const;
    /// Where a sample of the terrain lies on the overview.
    [[nodiscard]] glm::dvec2 on_overview(glm::dvec2 sample) const;
    [[nodiscard]] glm::dvec2 from_overview(glm::dvec2 sample) const;
    /// Within the overview's columns where it goes all around the Earth; else as it is.
    [[nodiscard]] glm::dvec2 around_overview(glm::dvec2 overview_sample) const;
    /// The rows of the terrain's samples.
    [[nodiscard]] const geo::ClosedRows& rows() const { return rows_; }
    /// Whether a tile has all samples of the terrain: finer ones show only images finer.
    [[nodiscard]] bool has_all_samples(terrain::TreeTile tile) const;
    /// Texels along the sides of a tile with a picture.
    [[nodiscard]] glm::ivec2 picture_size(terrain::TreeTile tile) const;
    /// Metres between them.
    [[nodiscard]] double texel(int level) const;
    /// Of a tile of full size, at most.
    [[nodiscard]] std::size_t bytes_per_tile() const;
    /// Metres from vertex to vertex at a level.
    [[nodiscard]] double spacing(int level) const;

    /// Heights as make() takes them, averages over a step, as far as the overview has them: NaN at
    /// its voids.
    [[nodiscard]] Grid<float> overview_heights(terrain::TreeTile tile) const;
    /// The error of a tile that is made of the overview but is finer: see StreamedTile::error, at
    /// the overview's own samples. 0 for all others.
    [[nodiscard]] double overview_error(terrain::TreeTile tile) const;
    /// `heights`: metres at the vertices and one step around them, NaN where there is none: those
    /// voids are filled with what the overview has. The picture, where there is one, has
    /// picture_size.
    [[nodiscard]] StreamedTile make(terrain::TreeTile tile, Grid<float> heights,
                                    const TilePicture& picture = {}) const;
    /// The box of a tile whose heights are in `range`.
    [[nodiscard]] Box bounds(terrain::TreeTile tile, terrain::HeightRange range) const;
    /// Where a vertex stands at another height, local metres.
    [[nodiscard]] glm::dvec3 place(terrain::TreeTile tile, glm::ivec2 vertex, double height) const;

private:
    [[nodiscard]] Rgba8 color_at(glm::dvec2 overview_sample, float height) const;
    [[nodiscard]] Image vertex_colors(const StreamedTile& tile, const Grid<float>& around,
                                      const Grid<std::uint8_t>& voids, bool with_overview) const;
    [[nodiscard]] int texels_per_cell(int level) const;
    std::shared_ptr<const TerrainSurface> overview_;
    terrain::TileTree tree_;
    int reduction_;
    ImageryDetail imagery_;
    geo::ClosedRows rows_;
    geo::ClosedRows overview_rows_;
    terrain::HeightTint tint_;
};

/// What a tile sends to the eye: its colour in the light, of the albedo's size, sRGB. Light is
/// linear between vertices.
Image lit_tile(const TileBuilder& maker, const StreamedTile& tile,
               const TerrainIrradiance& irradiance);

} // namespace reljef::scene
