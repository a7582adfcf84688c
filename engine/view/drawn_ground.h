#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/scene/streamed_tile.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::view {

/// The ground that streamed tiles on a plane show together.
class DrawnGround {
public:
    /// Precondition: of a terrain on a plane; outlives it.
    explicit DrawnGround(const scene::TileBuilder& maker);

    /// Precondition: it overlaps none that is there.
    void add(std::shared_ptr<const scene::StreamedTile> tile);

    /// As terrain::GroundRange, in local metres.
    [[nodiscard]] std::optional<terrain::HeightRange> range(glm::dvec2 low, glm::dvec2 high) const;

private:
    struct Part {
        glm::dvec2 first{0.0}; // sample of the tree
        glm::dvec2 end{0.0};
        double step = 1.0; // samples of the tree from vertex to vertex
        std::shared_ptr<const scene::StreamedTile> tile;
    };
    // A tile of the tree: a part, or what is below it.
    struct Branch {
        int part = -1;
        std::array<int, 4> below{-1, -1, -1, -1}; // branches
    };
    [[nodiscard]] glm::dvec2 sample_of(glm::dvec2 place) const;
    [[nodiscard]] const Part* part_at(glm::dvec2 sample) const;
    [[nodiscard]] std::optional<terrain::HeightRange> range_within(glm::dvec2 first,
                                                                   glm::dvec2 end) const;

    const scene::TileBuilder* maker_;
    glm::dvec2 last_{0.0}; // sample of the tree
    std::vector<Part> parts_;
    std::vector<Branch> branches_; // the root first
};

} // namespace reljef::view
