#pragma once

#include <cstdint>
#include <vector>

#include "terrains/urban/urban_shapes.h"

namespace reljef::terrains::urban {

enum class StreetKind : std::uint8_t { lane, street, avenue, boulevard, river };

/// Where another street meets this one.
struct Junction {
    float at = 0.0F;       ///< metres along this street
    float half = 0.0F;     ///< half the width of the other roadway along this street
    bool crossing = false; ///< this street has zebra stripes here
};

struct Street {
    glm::vec2 origin{0.0F, 0.0F};
    glm::vec2 tangent{1.0F, 0.0F};
    float half_width = 8.0F; ///< from the middle to the blocks
    float sidewalk = 3.0F;
    float water = 0.0F; ///< half the width of a river's water, else 0
    StreetKind kind = StreetKind::street;
    std::uint32_t seed = 0;
    std::vector<Junction> junctions; ///< by `at`

    [[nodiscard]] float roadway() const { return half_width - sidewalk; }
    [[nodiscard]] float along(glm::vec2 point) const { return dot(tangent, point - origin); }
};

/// The area between the middles of the streets around a block.
struct Cell {
    Convex outline;
    std::vector<std::size_t> streets; ///< index of the street under each edge
};

/// A periodic deformation of the plane that makes straight streets curve.
class Warp {
public:
    Warp() = default;
    Warp(float period, std::uint32_t seed);

    [[nodiscard]] glm::vec2 city_from_ground(glm::vec2 ground) const;
    [[nodiscard]] glm::vec2 ground_from_city(glm::vec2 city) const;
    /// Largest relative change of a distance.
    static constexpr float strain = 0.22F;

private:
    struct Wave {
        glm::vec2 turns{0.0F, 0.0F}; ///< waves per metre
        glm::vec2 amplitude{0.0F, 0.0F};
        float phase = 0.0F;
    };
    std::vector<Wave> waves_;
};

/// Streets and cells of a city that repeats every `period` metres in both directions.
struct StreetPlan {
    float period = 0.0F;
    std::vector<Street> streets;
    std::vector<Cell> cells;
    Warp warp;
};

/// Divides a city by boulevards and a river, then by avenues, streets and lanes.
/// Precondition: period > 0.
StreetPlan plan_streets(float period, std::uint32_t seed);

} // namespace reljef::terrains::urban
