#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/geometry.h"
#include "engine/scene/streaming/tile_builder.h"
#include "engine/terrain/field/earth_horizon.h"
#include "engine/terrain/field/horizon.h"

namespace reljef::view {

/// The ground that streamed tiles show together.
class DrawnGround {
public:
    /// The builder outlives this object.
    explicit DrawnGround(const scene::TileBuilder& builder);

    /// Precondition: the tile overlaps no other one.
    void add(std::shared_ptr<const scene::TerrainTile> tile);

    /// As terrain::GroundRange, over samples of the overview.
    [[nodiscard]] std::optional<terrain::HeightRange>
    range(const terrain::SampleRectangle& samples) const;

private:
    // Samples are those of the tree.
    struct Part {
        glm::dvec2 first{0.0};
        glm::dvec2 end{0.0};
        double step = 1.0; // samples between vertices
        std::shared_ptr<const scene::TerrainTile> tile;
    };
    // A node of the tree: a part, or four children.
    struct Branch {
        int part = -1;
        std::array<int, 4> children{-1, -1, -1, -1};
    };
    [[nodiscard]] const Part* part_at(glm::dvec2 sample) const;
    [[nodiscard]] std::optional<terrain::HeightRange> range_within(glm::dvec2 first,
                                                                   glm::dvec2 end) const;

    const scene::TileBuilder* builder_;
    glm::dvec2 last_{0.0};
    std::vector<Part> parts_;
    std::vector<Branch> branches_; // the root first
};

/// The ground of nearer tiles, which may hide farther tiles of the same stream.
class NearerGround {
public:
    /// Without a view nothing hides anything.
    NearerGround(const scene::TileBuilder& builder, const std::optional<terrain::HorizonView>& view,
                 const std::optional<terrain::EarthHorizon>& earth = std::nullopt);
    NearerGround(const NearerGround&) = delete;
    /// The same ground, whose horizon has `resolution` times as many sectors and stretches.
    [[nodiscard]] NearerGround finer(int resolution) const { return {*this, resolution}; }

    /// Adds a drawn tile. Precondition: as DrawnGround::add.
    void add(std::shared_ptr<const scene::TerrainTile> tile) { ground_.add(std::move(tile)); }
    /// Adds the tile under the eye if it is outside the picture; null: it is not loaded.
    void add_under_eye(std::shared_ptr<const scene::TerrainTile> tile);

    /// As terrain::Horizon::hides, or behind the curved Earth. `along`: metres from the eye to the
    /// box along the ground. Precondition: all nearer tiles were added.
    [[nodiscard]] bool hides(const Box& box, double along);

private:
    NearerGround(const NearerGround& coarser, int resolution);
    [[nodiscard]] std::optional<terrain::HeightRange> range_at_eye(const DrawnGround& ground) const;
    void make_horizon();

    const scene::TileBuilder& builder_;
    std::optional<terrain::HorizonView> view_;
    std::optional<terrain::EarthHorizon> earth_;
    int resolution_ = 1;
    DrawnGround ground_;
    std::optional<double> under_eye_; // the highest ground there, metres
    bool was_made_ = false;
    std::optional<terrain::Horizon> horizon_; // empty: nothing certainly hides anything
};

} // namespace reljef::view
