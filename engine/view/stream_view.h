#pragma once

#include <memory>
#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "engine/scene/graph/scene.h"
#include "engine/scene/tile_stream.h"
#include "engine/view/error_view.h"

namespace reljef::view {

/// Largest distance between the vertices of unproven tiles on the picture, in error bounds.
inline constexpr double samples_apart_in_errors = 4.0;

/// A loaded tile, or the summary of one that is not.
struct KnownTile {
    scene::TileSummary summary;
    std::shared_ptr<const scene::TerrainTile> tile; ///< null: not loaded
};

/// The tiles of a streamed terrain as a camera sees them: which may be visible, and how large their
/// errors are. Valid as long as its arguments.
class StreamView {
public:
    StreamView(const scene::TerrainNode& terrain, const scene::Camera& camera, glm::ivec2 size,
               const glm::dmat4& world_from_local);

    [[nodiscard]] const scene::TileStream& stream() const { return stream_; }
    [[nodiscard]] const scene::TileBuilder& builder() const { return stream_.maker(); }
    /// Empty if nothing can be hidden.
    [[nodiscard]] const std::optional<terrain::HorizonView>& horizon() const { return horizon_; }

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
    /// Metres from the eye to the nearest point of a tile's bounds.
    [[nodiscard]] double distance_to(const scene::TileSummary& tile) const;

    /// How far pixels of a tile are off at most, if it is proven; otherwise an estimate. Pixels.
    [[nodiscard]] double error_of(const scene::TileSummary& tile) const;
    /// A bound of the error of a loaded, proven tile, by the heights that are drawn, pixels.
    /// `is_hidden(box)`: whether something else covers a part of the tile (local metres).
    template <class IsHidden>
    [[nodiscard]] double tight_error_of(const scene::TerrainTile& tile,
                                        const IsHidden& is_hidden) const {
        return largest_block_error(
            tile, scene::cells_per_block,
            [&blocks = tile.blocks](int col, int row) {
                const terrain::MinMax block = blocks(col, row);
                return terrain::HeightRange{block.low, block.high};
            },
            [&](const Box& box) { return may_show(box) && !is_hidden(box); });
    }
    /// Whether the error of a tile leaves the triangles too little of the error bound.
    [[nodiscard]] bool is_over_share(double error) const;
    /// The error of a tile, or the size of its texels, relative to what is allowed.
    [[nodiscard]] double relative_error_of(const scene::TileSummary& tile) const;

private:
    [[nodiscard]] Box child_bounds(const scene::TileSummary& parent, terrain::TreeTile child,
                                   double errors) const;
    [[nodiscard]] double error_in(const Box& box, double error) const;
    /// Whether triangles may show places of a box.
    [[nodiscard]] bool may_show(const Box& local) const;
    template <class RangeOf, class IsSeen>
    [[nodiscard]] double largest_block_error(const scene::TileSummary& tile, int cells_per_block,
                                             const RangeOf& range_of, const IsSeen& is_seen) const {
        const glm::ivec2 cells = stream_.tree().cells(tile.id);
        double largest = 0.0;
        for (int row = 0; row * cells_per_block < cells.y; ++row) {
            for (int col = 0; col * cells_per_block < cells.x; ++col) {
                const glm::ivec2 first = glm::ivec2(col, row) * cells_per_block;
                const glm::ivec2 last = glm::min(first + cells_per_block, cells);
                const Box box = builder().bounds(tile.id, first, last, range_of(col, row));
                if (is_seen(box)) {
                    const double share = terrain::share_at(tile.block_shares, first);
                    largest = std::max(largest, error_in(box, share * tile.error));
                }
            }
        }
        return largest;
    }
    [[nodiscard]] double pixels_per_metre(double distance) const;

    const scene::TileStream& stream_;
    const scene::Camera& camera_;
    const glm::dmat4& world_from_local_;
    double max_error_; // pixels, without the rasterizer's error
    Frustum frustum_;
    WiderPicture wider_; // contains the true places of all pixels that keep the error bound
    Frustum wider_frustum_;
    PictureError picture_error_;
    glm::dvec3 eye_{0.0}; // local metres
    bool is_perspective_ = true;
    double pixels_per_metre_ = 1.0; // in perspective: at a distance of one metre
    std::optional<terrain::HorizonView> horizon_;
};

} // namespace reljef::view
