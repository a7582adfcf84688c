#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "engine/scene/graph/scene.h"
#include "engine/scene/streaming/tile_stream.h"
#include "engine/terrain/field/earth_horizon.h"
#include "engine/view/error_view.h"

namespace reljef::view {

/// Largest distance between the vertices of unproven tiles on the picture, in error bounds.
inline constexpr double samples_apart_in_errors = 4.0;

/// Of the error bound, for the triangles of the tile with the largest error: the frame states the
/// error of that tile.
inline constexpr double min_share_of_triangles = 1.0 / 16.0;

/// The tiles' share of the error bound where memory suffices; the rest is for fewer triangles.
inline constexpr double share_of_tiles = 0.5;

/// The largest relative error of a tile in a frame that keeps the error bound.
inline constexpr double max_kept_relative_error = (1.0 - min_share_of_triangles) / share_of_tiles;

/// A loaded tile, or the summary of one that is not.
struct KnownTile {
    scene::TileSummary summary;
    std::shared_ptr<const scene::TerrainTile> tile; ///< null: not loaded
};

/// The tiles of a streamed terrain as a camera sees them: which may be visible, and how large their
/// errors are. Valid as long as its arguments. Not for several threads at once.
class StreamView {
public:
    StreamView(const scene::TerrainNode& terrain, const scene::Camera& camera, glm::ivec2 size,
               const glm::dmat4& world_from_local);

    [[nodiscard]] const scene::TileStream& stream() const { return stream_; }
    [[nodiscard]] const scene::TileBuilder& builder() const { return stream_.maker(); }
    /// Maximum number of tiles in a view.
    [[nodiscard]] std::size_t max_drawn() const { return max_drawn_; }
    /// Empty if nothing can be hidden.
    [[nodiscard]] const std::optional<terrain::HorizonView>& horizon() const { return horizon_; }
    /// Empty if the Earth hides nothing.
    [[nodiscard]] const std::optional<terrain::EarthHorizon>& earth_horizon() const {
        return earth_horizon_;
    }

    [[nodiscard]] std::optional<KnownTile> known(terrain::TreeTile id) const;
    /// Whether a box in local metres may be on the picture.
    [[nodiscard]] bool may_see(const Box& local) const;
    /// Whether a tile's samples may be on the picture: a bound if they are proven, otherwise
    /// expected from the parent.
    [[nodiscard]] bool may_see_child(const scene::TileSummary& parent,
                                     terrain::TreeTile child) const;
    /// The local bounds of all samples of a tile, to tell whether it is hidden. Without a proof
    /// they are expected, with a wide margin.
    [[nodiscard]] Box hiding_bounds(const scene::TileSummary& tile) const;
    [[nodiscard]] Box hiding_bounds(const scene::TileSummary& parent,
                                    terrain::TreeTile child) const;

    /// Metres along the local ground from the eye to the nearest point of a local box.
    [[nodiscard]] double along(const Box& local) const;
    /// Metres from the eye to the nearest point of a local box.
    [[nodiscard]] double distance_to(const Box& local) const;

    /// How far pixels of a tile are off at most, if it is proven; otherwise an estimate. Pixels.
    /// Computed once for each proven tile.
    [[nodiscard]] double error_of(const scene::TileSummary& tile) const;
    /// A bound of the error of a loaded, proven tile, by the heights that are drawn, pixels.
    /// `is_hidden(box)`: whether something else covers a part of the tile (local metres). At least
    /// `min_error`: parts with smaller errors are not looked at.
    template <class IsHidden>
    [[nodiscard]] double tight_error_of(const scene::TerrainTile& tile, const IsHidden& is_hidden,
                                        double min_error = 0.0) const {
        double largest = min_error;
        for (int row = 0; row < tile.blocks.rows(); ++row) {
            for (int col = 0; col < tile.blocks.cols(); ++col) {
                largest = largest_error_in(tile, block_of(tile, {col, row}), largest, is_hidden);
            }
        }
        return largest;
    }
    /// The same of the quarters of a tile below which no tile of `known` lies; empty: none of them
    /// is seen.
    [[nodiscard]] std::optional<double>
    error_beside(const scene::TerrainTile& tile, const std::set<terrain::TreeTile>& known) const;
    /// The largest error of a tile in a frame that keeps the error bound, pixels.
    [[nodiscard]] double max_kept_error() const {
        return (1.0 - min_share_of_triangles) * max_error_;
    }
    /// Whether the error of a tile leaves the triangles too little of the error bound.
    [[nodiscard]] bool is_over_share(double error) const;
    /// The error of a tile, or the size of its texels, relative to what is allowed; finite, and
    /// less than that of its parent, so that tiles can be refined in this order.
    [[nodiscard]] double relative_error_of(const scene::TileSummary& tile, double of_parent) const;

private:
    void find_horizon(glm::ivec2 size);
    [[nodiscard]] Box child_bounds(const scene::TileSummary& parent, terrain::TreeTile child,
                                   double errors) const;
    [[nodiscard]] double error_in(const Box& box, double error) const;
    /// Whether triangles may show places of a box.
    [[nodiscard]] bool may_show(const Box& local) const;
    // The errors of a proven tile, pixels: of all of it, and of its visible blocks.
    [[nodiscard]] double error_of_proven(const scene::TileSummary& tile) const;
    [[nodiscard]] double error_of_blocks(const scene::TileSummary& tile) const;
    // A rectangle of a loaded tile between two places in vertices, in one block.
    struct Part {
        glm::dvec2 first{0.0};
        glm::dvec2 last{0.0};
        Box box; // of its surface, local metres
    };
    [[nodiscard]] static Part block_of(const scene::TerrainTile& tile, glm::ivec2 block);
    static Part with_box(const scene::TerrainTile& tile, glm::dvec2 first, glm::dvec2 last,
                         terrain::HeightRange drawn);
    [[nodiscard]] static Part part_of(const scene::TerrainTile& tile, glm::dvec2 first,
                                      glm::dvec2 last);
    [[nodiscard]] double error_of_part(const scene::TerrainTile& tile, const Part& part) const;
    [[nodiscard]] bool is_divided(const Part& part) const;
    [[nodiscard]] static std::array<Part, 4> quarters_of(const scene::TerrainTile& tile,
                                                         const Part& part);
    // Divides parts as long as they may raise `largest`.
    template <class IsHidden>
    [[nodiscard]] double largest_error_in(const scene::TerrainTile& tile, const Part& part,
                                          double largest, const IsHidden& is_hidden) const {
        if (!may_show(part.box)) {
            return largest;
        }
        const double error = error_of_part(tile, part);
        if (error <= largest || is_hidden(part.box)) {
            return largest;
        }
        if (!is_divided(part)) {
            return error;
        }
        for (const Part& quarter : quarters_of(tile, part)) {
            largest = largest_error_in(tile, quarter, largest, is_hidden);
        }
        return largest;
    }
    [[nodiscard]] double relative_error(const scene::TileSummary& tile) const;
    [[nodiscard]] double pixels_per_metre(double distance) const;

    const scene::TerrainNode& terrain_;
    const scene::TileStream& stream_;
    const scene::Camera& camera_;
    const glm::dmat4& world_from_local_;
    std::size_t max_drawn_;
    double max_error_; // pixels, without what floats and the rasterizer add
    double max_shift_; // pixels, without what the rasterizer adds
    Frustum frustum_;
    WiderPicture wider_; // contains the true places of all pixels that keep the error bound
    Frustum wider_frustum_;
    PictureError picture_error_;
    glm::dvec3 eye_{0.0}; // local metres
    bool is_perspective_ = true;
    double pixels_per_metre_ = 1.0; // in perspective: at a distance of one metre
    std::optional<terrain::HorizonView> horizon_;
    std::optional<terrain::EarthHorizon> earth_horizon_;
    // Of proven tiles, as far as known: a tile's proof never changes.
    mutable std::map<terrain::TreeTile, double> errors_;
};

} // namespace reljef::view
