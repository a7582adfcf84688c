#include "engine/scene/motion/ground_contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/scene/streaming/streamed_samples.h"
#include "tests/support/release_only.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::scene {
namespace {

TerrainNode node_of(terrain::Heightfield heightfield, double exaggeration = 1.0) {
    auto surface = TerrainSurface::create(std::make_shared<const terrain::Terrain>(terrain::Terrain{
                                              "made", std::move(heightfield), {}, {}}),
                                          {.placement = {}, .exaggeration = exaggeration});
    EXPECT_TRUE(surface);
    return {std::make_shared<const TerrainSurface>(std::move(*surface)), {}};
}

// A ramp that rises by 0.5 to the east and falls by 0.25 to the north.
TerrainNode ramp_node() {
    return node_of(test::plane_heightfield(
        test::made_heights(41, 31, [](int col, int row) { return 3.0 + col + 0.5 * row; }),
        {2.0, 2.0}));
}

TEST(GroundContact, OnARampIsThatOfATangentPlane) {
    const TerrainNode node = ramp_node();
    const glm::dvec3 normal = glm::normalize(glm::dvec3(-0.5, 0.25, 1.0));
    const double middle = 3.0 + 20.0 + 0.5 * 15.0;
    for (const Ellipsoid shape : {Ellipsoid{0.4, 0.9}, {3.0, 3.0}, {8.0, 0.5}, {0.01, 5.0}}) {
        for (const glm::dvec2 at : {glm::dvec2(0.0), {3.1, -4.2}, {-11.0, 7.3}}) {
            const auto contact = ground_contact(node, shape, {at, 100.0});
            ASSERT_TRUE(contact);
            const double ground = middle + 0.5 * at.x - 0.25 * at.y;
            const double slope = std::hypot(0.5, 0.25) * shape.radius;
            EXPECT_NEAR(100.0 + contact->lift, ground + std::hypot(shape.half_height, slope), 1e-7);
            EXPECT_LE(glm::distance(contact->normal, normal), 1e-5);
        }
    }
}

TEST(GroundContact, FollowsExaggeration) {
    const auto flat = [] { return test::plane_heightfield(Grid<float>(5, 5, 7.0F)); };
    const auto contact = ground_contact(node_of(flat(), 3.0), {1.0, 2.0}, {0.2, 0.3, 20.0});
    ASSERT_TRUE(contact);
    EXPECT_NEAR(contact->lift, 3.0 * 7.0 + 2.0 - 20.0, 1e-9);
    EXPECT_EQ(contact->normal, glm::dvec3(0.0, 0.0, 1.0));
}

TEST(GroundContact, BesideTheTerrainThereIsNone) {
    const TerrainNode node = ramp_node();
    EXPECT_TRUE(ground_contact(node, {}, {40.0, 30.0, 0.0}));
    EXPECT_FALSE(ground_contact(node, {}, {40.1, 0.0, 0.0}));
    EXPECT_FALSE(ground_contact(node, {}, {0.0, -30.1, 0.0}));
    EXPECT_FALSE(ground_contact(node, {}, {std::nan(""), 0.0, 0.0}));
    EXPECT_FALSE(ground_contact(node, {}, {0.0, 0.0, HUGE_VAL}));
}

TEST(GroundContactDeathTest, NeedsAnEllipsoid) {
    EXPECT_DEATH((void)ground_contact(ramp_node(), {0.0, 1.0}, {}), "an ellipsoid");
}

class ContactsOfSources : public testing::TestWithParam<test::SampleSource> {};
INSTANTIATE_TEST_SUITE_P(Sources, ContactsOfSources, test::all_sources(), test::name_of_source);

// Loads all tiles.
void load(const TerrainNode& node) {
    if (node.stream == nullptr) {
        return;
    }
    std::vector<terrain::TreeTile> tiles{node.stream->tree().root()};
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        for (const terrain::TreeTile child : node.stream->tree().children(tiles[i])) {
            tiles.push_back(child);
        }
    }
    node.stream->request(tiles);
    ASSERT_TRUE(node.stream->wait({}));
}

// Heights at which an ellipsoid touches places of the surface: never above that of the contact, and
// the highest of many is near it.
void compare_with_many_places(const TerrainNode& node, const Ellipsoid& shape, glm::dvec2 at) {
    const auto contact = ground_contact(node, shape, {at, 0.0});
    ASSERT_TRUE(contact);
    double highest = -HUGE_VAL;
    constexpr int side = 150;
    for (int j = -side; j <= side; ++j) {
        for (int i = -side; i <= side; ++i) {
            const glm::dvec2 part = glm::dvec2(i, j) / static_cast<double>(side);
            const glm::dvec2 place = at + shape.radius * part;
            const auto ground =
                glm::length(part) < 1.0 ? node.surface->height_at(place.x, place.y) : std::nullopt;
            if (ground) {
                const double below = shape.half_height * std::sqrt(1.0 - glm::dot(part, part));
                highest = std::max(highest, *ground + below);
            }
        }
    }
    EXPECT_GE(contact->lift, highest - 1e-6);
    // The steepest ground rises by 100 between samples 2 m apart.
    EXPECT_LE(contact->lift, highest + 0.05 * shape.half_height + 50.0 * shape.radius / side);
}

TEST_P(ContactsOfSources, IsTheHighestOfAllPlacesBelow) {
    TerrainNode node = node_of(
        test::plane_heightfield(test::random_heights(101, 91, -20.0F, 60.0F, 3), {2.0, 3.0}));
    test::give_samples(node, GetParam());
    load(node);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> x(-99.0, 99.0);
    std::uniform_real_distribution<double> y(-130.0, 130.0);
    for (const Ellipsoid shape : {Ellipsoid{0.4, 0.9}, {3.0, 3.0}, {0.5, 200.0}, {12.0, 1.0}}) {
        for (int i = 0; i < test::rounds(25, 8); ++i) {
            compare_with_many_places(node, shape, {x(random), y(random)});
        }
    }
    // Across the border between tiles.
    compare_with_many_places(node, {3.0, 3.0}, {-100.0 + 128.0 + 0.3, 135.0 - 192.0 - 0.2});
}

// Against one whose samples are farther apart, so that it lies over one cell, it is exact.
TEST(GroundContact, IsExactOverATwistedCell) {
    Grid<float> heights(2, 2, 0.0F);
    heights(1, 0) = 40.0F;
    heights(0, 1) = 30.0F;
    const TerrainNode node = node_of(test::plane_heightfield(std::move(heights), {10.0, 10.0}));
    for (const Ellipsoid shape : {Ellipsoid{2.0, 0.3}, {2.0, 3.0}, {4.0, 4.0}, {1.0, 0.01}}) {
        const auto contact = ground_contact(node, shape, {0.4, -0.3, 0.0});
        ASSERT_TRUE(contact);
        double highest = -HUGE_VAL;
        constexpr int rays = 20'000;
        for (int i = 0; i < rays; ++i) {
            const double angle = 2.0 * glm::radians(180.0) * i / rays;
            for (double share = 0.0; share < 1.0; share += 0.001) {
                const glm::dvec2 part = share * glm::dvec2(std::cos(angle), std::sin(angle));
                const glm::dvec2 place = glm::dvec2(0.4, -0.3) + shape.radius * part;
                const double u = 0.5 + 0.1 * place.x;
                const double v = 0.5 - 0.1 * place.y;
                highest = std::max(highest, 40.0 * u * (1.0 - v) + 30.0 * v * (1.0 - u) +
                                                shape.half_height * std::sqrt(1.0 - share * share));
            }
            i += 9;
        }
        EXPECT_GE(contact->lift, highest - 1e-9) << shape.radius;
        EXPECT_LE(contact->lift, highest + 0.02) << shape.radius;
    }
}

TEST_P(ContactsOfSources, OnTheEllipsoidNothingIsInTheGround) {
    TerrainNode node = node_of(test::geographic_heightfield(
        test::random_heights(81, 71, 0.0F, 900.0F, 5), 46.0, 7.0, 0.01, 20.0));
    ASSERT_EQ(node.surface->placement().kind(), terrain::PlacementKind::ellipsoid);
    test::give_samples(node, GetParam());
    load(node);
    const terrain::Placement& placement = node.surface->placement();
    const Ellipsoid shape{400.0, 300.0};
    std::mt19937 random(6);
    std::uniform_real_distribution<double> place(5.0, 65.0);
    for (int i = 0; i < 20; ++i) {
        const glm::dvec3 center =
            placement.world_from_sample({place(random), place(random), 500.0});
        const auto contact = ground_contact(node, shape, center);
        ASSERT_TRUE(contact);
        const glm::dvec3 up = placement.up(center);
        const glm::dvec3 north = placement.north(center);
        const glm::dvec3 east = glm::cross(north, up);
        double nearest = HUGE_VAL;
        for (int j = -60; j <= 60; ++j) {
            for (int k = -60; k <= 60; ++k) {
                const glm::dvec2 part = glm::dvec2(j, k) / 60.0;
                if (glm::length(part) >= 1.0) {
                    continue;
                }
                const glm::dvec3 low =
                    center + shape.radius * (part.x * east + part.y * north) +
                    (contact->lift - shape.half_height * std::sqrt(1.0 - glm::dot(part, part))) *
                        up;
                const auto sample = placement.sample_from_world(low);
                nearest = std::min(
                    nearest,
                    sample->z - terrain::bilinear_height(node.surface->heightfield().heights.view(),
                                                         glm::dvec2(*sample)));
            }
        }
        // Below 400 m the Earth falls by 1.3 cm.
        EXPECT_GE(nearest, -0.03) << i;
        EXPECT_LE(nearest, 10.0) << i;
    }
}

// The surface of the finest loaded tiles counts, where nothing finer is loaded that of coarser
// ones.
TEST(GroundContact, OfAStreamIsThatOfItsLoadedTiles) {
    TerrainNode node =
        node_of(test::plane_heightfield(test::random_heights(257, 257, 0.0F, 50.0F, 7)));
    test::stream_samples(node, test::SeenLevels::finest);
    const auto lift = [&] { return ground_contact(node, {0.5, 0.5}, {-60.3, 60.2, 0.0})->lift; };
    const double of_overview = lift();
    node.stream->request(std::array{node.stream->tree().root()});
    ASSERT_TRUE(node.stream->wait({}));
    EXPECT_NE(lift(), of_overview) << "the coarsest tile";
    load(node);
    EXPECT_NEAR(lift(), of_overview, 1e-5) << "the overview has all samples";
}

} // namespace
} // namespace reljef::scene
