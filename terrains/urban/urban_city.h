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
    stalls ///< asphalt with the white lines of parking places
};

struct Patch {
    Footprint shape;
    Frame frame;
    Surface surface = Surface::paving;
    std::uint32_t seed = 0;
};

enum class Cover : std::uint8_t { gravel, tar, membrane, concrete, tiles, metal, green };

struct Building {
    Footprint shape;
    Convex outline;
    glm::vec2 axis{1.0F, 0.0F};
    float eaves = 9.0F;       ///< metres above the street
    float slope = 0.0F;       ///< rise over run from the sloped edges; 0: flat
    float rise_limit = 1e9F;  ///< metres from the eaves to the flat top of a mansard roof
    float parapet = 0.0F;     ///< metres above a flat roof
    std::uint32_t sloped = 0; ///< bit i: the roof rises from edge i
    Cover cover = Cover::gravel;
    Color color{0.5F, 0.5F, 0.5F};
    Color rim{0.6F, 0.6F, 0.6F}; ///< parapet or gutter
    std::uint32_t seed = 0;
};

enum class PrismKind : std::uint8_t { box, car, hedge, panel, glass, well };
/// Others stand on roofs, or cut into them.
constexpr bool stands_on_ground(PrismKind kind) {
    return kind == PrismKind::car || kind == PrismKind::hedge;
}

/// An upright box, for example a car or a hedge. A well goes down to `top`.
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

struct Block {
    Cell cell;
    Convex lot; ///< inside the sidewalks; may be empty
    Surface ground = Surface::paving;
    Box bounds; ///< of the block and its contents
    std::vector<Patch> patches;
    std::vector<Building> buildings;
    std::vector<Prism> prisms;
    std::vector<Tree> trees;
};

class BlockBuilder {
public:
    BlockBuilder(Block& block, std::uint32_t seed) : random(seed), block_(block) {}

    Random random;

    [[nodiscard]] const Convex& lot() const { return block_.lot; }
    void ground(Surface surface) { block_.ground = surface; }
    void patch(const Convex& shape, Surface surface);
    /// Parking places and cars on both long sides of a frame, on one side if it is narrow.
    void parking(const Frame& frame);
    void tree(glm::vec2 center, float size = 1.0F);
    /// About one tree per `spacing`² square metres, at random places.
    void grove(const Convex& shape, float spacing, float size = 1.0F);
    void box(const Frame& frame, float top, Color color, PrismKind kind = PrismKind::box);
    void car(glm::vec2 center, glm::vec2 axis);
    void hedge(glm::vec2 from, glm::vec2 to);
    void building(const Convex& shape, Building building);
    /// A building with a flat roof and objects on it.
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

void build_perimeter(BlockBuilder& builder); ///< rings of houses around courtyards
void build_downtown(BlockBuilder& builder);  ///< dense lots with towers
void build_houses(BlockBuilder& builder);    ///< houses in gardens
void build_slabs(BlockBuilder& builder);     ///< slabs on lawns, with parking
void build_halls(BlockBuilder& builder);     ///< halls, yards and parking
void build_park(BlockBuilder& builder);
void build_square(BlockBuilder& builder); ///< a paved square with a church

struct CityPlan {
    StreetPlan plan;
    std::vector<Block> blocks;
};

/// A copy of a block on the repeating plane.
struct BlockCopy {
    const Block* block;
    glm::vec2 shift;
};

/// The copies that touch a box of the city.
std::vector<BlockCopy> copies_in(const CityPlan& city, const Box& box);

/// Precondition: period > 0.
CityPlan build_city(float period, std::uint32_t seed, unsigned threads);

} // namespace reljef::terrains::urban
