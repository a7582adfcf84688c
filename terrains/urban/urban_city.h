#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "terrains/urban/urban_shapes.h"
#include "terrains/urban/urban_streets.h"

namespace reljef::terrains::urban {

/// sRGB-encoded, [0,1].
using Color = glm::vec3;

enum class Surface : std::uint8_t {
    asphalt,
    paving,
    gravel,
    lawn,
    meadow,
    soil,
    water,
    pool,
    path,
    court,
    stalls ///< asphalt with the white lines of parking places across its frame
};

/// Ground cover.
struct Patch {
    Footprint shape;
    Frame frame;
    Surface surface = Surface::paving;
    std::uint32_t seed = 0;
};

enum class Cover : std::uint8_t { gravel, tar, membrane, concrete, tiles, metal, green };

struct Building {
    Footprint shape;
    glm::vec2 axis{1.0F, 0.0F};
    float eaves = 9.0F;       ///< metres above the street
    float slope = 0.0F;       ///< rise over run from the sloped edges; 0: flat
    float rise_limit = 1e9F;  ///< a flat top above a mansard
    float parapet = 0.0F;     ///< metres above a flat roof
    std::uint32_t sloped = 0; ///< bit i: the roof rises from edge i
    Cover cover = Cover::gravel;
    Color color{0.5F, 0.5F, 0.5F};
    Color rim{0.6F, 0.6F, 0.6F}; ///< parapet or gutter: also the colour that walls take
    std::uint32_t seed = 0;
};

enum class PrismKind : std::uint8_t { box, car, hedge, panel, glass, well };

/// An upright box: a car, a machine on a roof, a hedge. A well goes down to `top`.
struct Prism {
    Frame frame;
    float top = 1.0F; ///< metres above the street
    PrismKind kind = PrismKind::box;
    Color color{0.6F, 0.6F, 0.6F};
};

struct Tree {
    glm::vec2 center{0.0F, 0.0F};
    float radius = 3.0F;
    float height = 8.0F;
    Color color{0.25F, 0.32F, 0.17F};
};

/// One cell of the plan with all that stands in it.
struct Block {
    Cell cell;
    Convex lot; ///< inside the sidewalks; empty where streets take all
    Surface ground = Surface::paving;
    std::uint32_t seed = 0;
    Box bounds; ///< of everything
    std::vector<Patch> patches;
    std::vector<Building> buildings;
    std::vector<Prism> prisms;
    std::vector<Tree> trees;
};

/// Adds to a block; the means all block builders share.
class BlockBuilder {
public:
    BlockBuilder(Block& block, std::uint32_t seed) : random(seed), block_(block) {}

    Random random;

    [[nodiscard]] const Convex& lot() const { return block_.lot; }
    void ground(Surface surface) { block_.ground = surface; }
    void patch(const Convex& shape, Surface surface);
    /// Parking places on both long sides of a frame (one if it is narrow), and cars on them.
    void parking(const Frame& frame);
    void tree(glm::vec2 center, float size = 1.0F);
    /// About one tree per `spacing`^2, at random places of the shape.
    void grove(const Convex& shape, float spacing, float size = 1.0F);
    void box(const Frame& frame, float top, Color color, PrismKind kind = PrismKind::box);
    void car(glm::vec2 center, glm::vec2 axis);
    void hedge(glm::vec2 from, glm::vec2 to);
    /// Adds as it is.
    void building(const Convex& shape, Building building);
    /// A flat roof and what stands on it.
    void flat_building(const Convex& shape, float eaves);
    /// `sloped`: see Building.
    void pitched_building(const Convex& shape, float eaves, std::uint32_t sloped);

private:
    void furnish(const Convex& roof, float top);
    void roof_box(const Convex& roof, float top, bool stairs);
    void solar_panels(const Convex& roof, float top);
    void chimneys(const Convex& shape, const Building& roof);

    Block& block_;
};

/// Rings of houses around courtyards.
void build_perimeter(BlockBuilder& builder);
/// Lots built over, with towers.
void build_downtown(BlockBuilder& builder);
/// Houses in gardens.
void build_houses(BlockBuilder& builder);
/// Slabs on lawns, with parking.
void build_slabs(BlockBuilder& builder);
/// Halls, yards and parking.
void build_halls(BlockBuilder& builder);
void build_park(BlockBuilder& builder);
/// A paved square with a church.
void build_square(BlockBuilder& builder);

/// Trees and cars along the streets of a cell.
void furnish_streets(const StreetPlan& plan, const Cell& cell, BlockBuilder& builder);

struct City {
    StreetPlan plan;
    std::vector<Block> blocks;
};

/// Precondition: period > 0.
City build_city(float period, std::uint32_t seed, unsigned threads);

} // namespace reljef::terrains::urban
