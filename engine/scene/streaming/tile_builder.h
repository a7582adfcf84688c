#pragma once

#include <bit>
#include <cstddef>
#include <memory>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/color.h"
#include "engine/core/geometry.h"
#include "engine/core/grid.h"
#include "engine/scene/streaming/terrain_light.h"
#include "engine/scene/streaming/terrain_surface.h"
#include "engine/scene/streaming/terrain_tile.h"
#include "engine/scene/streaming/tile_voids.h"
#include "engine/terrain/field/min_max_pyramid.h"
#include "engine/terrain/field/tint.h"
#include "engine/terrain/tree/tile_error.h"
#include "engine/terrain/tree/tile_tree.h"

namespace reljef::scene {

/// The imagery of a tile: texels edge to edge over its vertices, alpha 0 where there is no image;
/// empty: none.
struct TilePicture {
    Image texels;
    bool whole = true;     ///< false: parts were not read, the overview fills them
    bool has_more = false; ///< there are finer texels
};

/// Maximum texels between two vertices: then selected tiles show no texel larger than a pixel.
inline constexpr int max_texels_per_cell = 4;

/// Bytes of a drawn tile of full size with a picture.
std::size_t bytes_of_tile(int texels_per_cell);

/// The resolution of the tiles' imagery.
struct ImageryDetail {
    double finest_pixel = 0.0; ///< metres; 0: no images
    /// Samples of the tree per sample of the terrain: more than 1 if the finest tiles would show
    /// the images too coarsely.
    int refinement = 1;
    int max_texels = max_texels_per_cell; ///< between vertices; fewer take less memory
};

/// Builds the tiles of a terrain from their samples. Takes the placement, colours and shadows from
/// an overview of the whole terrain. Thread-safe.
class TileBuilder {
public:
    /// `reduction`: an overview sample is the middle of reduction × reduction samples of the
    /// terrain. `wrap`: the wrap of the tree's raster around the Earth.
    TileBuilder(std::shared_ptr<const TerrainSurface> overview, terrain::TileTree tree,
                int reduction, const ImageryDetail& imagery = {}, const geo::GlobalWrap& wrap = {});

    [[nodiscard]] const terrain::TileTree& tree() const { return tree_; }
    [[nodiscard]] const TerrainSurface& overview() const { return *overview_; }
    [[nodiscard]] int reduction() const { return reduction_.factor; }
    /// Samples of the terrain between vertices.
    [[nodiscard]] double step(terrain::TreeTile tile) const;
    /// The first sample of a tile, and the sample of a vertex, in the terrain.
    [[nodiscard]] glm::dvec2 first(terrain::TreeTile tile) const;
    [[nodiscard]] glm::dvec2 sample(terrain::TreeTile tile, glm::ivec2 vertex) const;
    /// The sample of the tree for a sample of the terrain.
    [[nodiscard]] glm::dvec2 tree_sample(glm::dvec2 sample) const {
        return sample * static_cast<double>(imagery_.refinement);
    }
    /// The sample of the overview for a sample of the terrain, and back.
    [[nodiscard]] glm::dvec2 on_overview(glm::dvec2 sample) const {
        return reduction_.on_overview(sample);
    }
    [[nodiscard]] glm::dvec2 from_overview(glm::dvec2 sample) const {
        return reduction_.from_overview(sample);
    }
    [[nodiscard]] terrain::TileLattice lattice(terrain::TreeTile tile) const;
    [[nodiscard]] terrain::Placement placement(terrain::TreeTile tile) const;
    /// Wraps a sample into the columns of an overview that goes around the Earth.
    [[nodiscard]] glm::dvec2 around_overview(glm::dvec2 overview_sample) const;
    [[nodiscard]] const geo::WrappedRows& rows() const { return reduction_.rows; }
    /// Whether a tile has all samples of the terrain. Finer tiles only have finer images.
    [[nodiscard]] bool has_all_samples(terrain::TreeTile tile) const;
    /// The level whose vertices are the samples of the terrain.
    [[nodiscard]] int level_of_samples() const {
        return std::countr_zero(static_cast<unsigned>(imagery_.refinement));
    }
    /// The tile of a level at a sample of the terrain, clamped to the terrain.
    [[nodiscard]] terrain::TreeTile tile_at(int level, glm::dvec2 sample) const;
    [[nodiscard]] bool has_images() const { return imagery_.finest_pixel > 0.0; }
    [[nodiscard]] glm::ivec2 picture_size(terrain::TreeTile tile) const;
    [[nodiscard]] double texel(int level) const;      ///< metres between texels
    [[nodiscard]] double spacing(int level) const;    ///< metres between vertices
    [[nodiscard]] std::size_t bytes_per_tile() const; ///< maximum

    /// Heights for make(): averages of the overview over a step, NaN at its voids.
    [[nodiscard]] Grid<float> overview_heights(terrain::TreeTile tile) const;
    /// TileSummary::error at the overview's samples, for a tile made from it that is finer than the
    /// overview; 0 for other tiles.
    [[nodiscard]] double overview_error(terrain::TreeTile tile) const;
    /// A tile's heights with voids filled from its own heights and the overview's. `heights`:
    /// metres at the vertices and one step around them; NaN: void. `was_void`: where heights are
    /// filled already (1); empty: they are not.
    [[nodiscard]] FilledHeights filled(terrain::TreeTile tile, Grid<float> heights,
                                       Grid<std::uint8_t> was_void = {}) const;
    /// `heights`, `was_void`: as for filled(). Precondition: the picture is empty or has
    /// picture_size.
    [[nodiscard]] TerrainTile make(terrain::TreeTile tile, Grid<float> heights,
                                   const TilePicture& picture = {},
                                   Grid<std::uint8_t> was_void = {}) const;
    /// The four vertices from `vertex` on, without imagery of the tile.
    [[nodiscard]] TerrainTile make_cell(terrain::TreeTile tile, glm::ivec2 vertex,
                                        const FilledHeights& filled) const;
    [[nodiscard]] Box bounds(terrain::TreeTile tile, terrain::HeightRange range) const;
    /// Between two vertices of a tile.
    [[nodiscard]] Box bounds(terrain::TreeTile tile, glm::ivec2 first_vertex,
                             glm::ivec2 last_vertex, terrain::HeightRange range) const;
    /// Of a tile with a proof, whether it was read or not, without its images. The range of the
    /// proof contains what fills voids.
    [[nodiscard]] TileSummary summary(terrain::TreeTile tile,
                                      const terrain::TileProof& proof) const;
    /// A vertex at another height, local metres.
    [[nodiscard]] glm::dvec3 place(terrain::TreeTile tile, glm::ivec2 vertex, double height) const;

private:
    [[nodiscard]] Rgba8 color_at(glm::dvec2 overview_sample, Rgba8 tint) const;
    [[nodiscard]] bool is_lake(glm::dvec2 overview_sample) const;
    [[nodiscard]] bool is_outside(glm::dvec2 overview_sample) const; // of a void
    [[nodiscard]] TerrainTile make_part(terrain::TreeTile tile, glm::ivec2 first,
                                        FilledHeights filled, bool with_overview) const;
    [[nodiscard]] Image vertex_colors(const TerrainTile& tile, glm::ivec2 first,
                                      const FilledHeights& filled, bool with_overview) const;
    [[nodiscard]] int texels_per_cell(int level) const;
    std::shared_ptr<const TerrainSurface> overview_;
    terrain::TileTree tree_;
    terrain::Reduction reduction_;
    ImageryDetail imagery_;
    terrain::HeightTint tint_;
    Grid<std::uint8_t> water_;   // of the overview; empty: the ramp draws none
    Grid<std::uint8_t> no_data_; // of the overview; empty: none
};

/// The lit albedo, sRGB. The light is interpolated between vertices. `threads` as parallel_for().
Image lit_tile(const TileBuilder& builder, const TerrainTile& tile,
               const TerrainIrradiance& irradiance, unsigned threads = 0);

/// lit_tile() in parts, for callers that compute shadows themselves.
struct LitTileParts {
    Image sky;
    Image sun; ///< without shadows
};
LitTileParts lit_tile_parts(const TileBuilder& builder, const TerrainTile& tile,
                            const TerrainIrradiance& irradiance, unsigned threads = 0);

} // namespace reljef::scene
