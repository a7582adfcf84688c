#include "bench/claims/cut_city.h"

#include <cmath>

#include <gtest/gtest.h>

namespace reljef::bench {
namespace {

constexpr int tile = 32;

float height_in(const CityPiece& piece, int col, int row) {
    return piece.surface->heightfield().heights(col - piece.begin.x, row - piece.begin.y);
}

bool covers(const CityPiece& piece, int col, int row) {
    const auto& heights = piece.surface->heightfield().heights;
    const glm::ivec2 place = glm::ivec2(col, row) - piece.begin;
    return place.x >= 0 && place.y >= 0 && place.x < heights.cols() && place.y < heights.rows();
}

// A colour for each cell.
void expect_same_colors(const CutCity& city) {
    const Image& whole = city.whole.surface->terrain().color;
    ASSERT_EQ(whole.cols(), city.whole.surface->heightfield().heights.cols() - 1);
    std::size_t cells = 0;
    for (const CityPiece& piece : city.pieces) {
        const Image& colors = piece.surface->terrain().color;
        cells += colors.size();
        for (int row = 0; row < colors.rows(); ++row) {
            for (int col = 0; col < colors.cols(); ++col) {
                ASSERT_EQ(colors(col, row), whole(piece.begin.x + col, piece.begin.y + row))
                    << col << ' ' << row;
            }
        }
    }
    EXPECT_EQ(cells, whole.size());
}

// Every sample of the whole, in each piece that covers it: four at an inner corner.
void expect_same_samples(const CutCity& city) {
    expect_same_colors(city);
    const auto& heights = city.whole.surface->heightfield().heights;
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            int found = 0;
            for (const CityPiece& piece : city.pieces) {
                if (covers(piece, col, row)) {
                    ++found;
                    ASSERT_EQ(height_in(piece, col, row), heights(col, row)) << col << ' ' << row;
                }
            }
            ASSERT_GE(found, 1) << col << ' ' << row;
        }
    }
}

TEST(CutCity, CopiesOfATileShareOneSurfaceAndTheirBorders) {
    const auto city = repeated_city(tile, 3, 1);
    ASSERT_TRUE(city) << city.error().message;
    ASSERT_EQ(city->pieces.size(), 9U);
    for (const CityPiece& piece : city->pieces) {
        EXPECT_EQ(piece.surface, city->pieces.front().surface);
    }
    EXPECT_EQ(city->whole.surface->heightfield().heights.cols(), 3 * tile + 1);
    EXPECT_GT(city->whole.surface->heightfield().range.high, 2.0);
    expect_same_samples(*city);
    EXPECT_FALSE(repeated_city(tile, 0, 1));
}

TEST(CutCity, OnlyPiecesWithBuildingsHaveTheirOwnSurface) {
    const LoneCityOptions options{.piece = tile, .city = 2, .pieces = 4, .threads = 1};
    const auto city = lone_city(options);
    ASSERT_TRUE(city) << city.error().message;
    ASSERT_EQ(city->pieces.size(), 16U);
    expect_same_samples(*city);
    int built = 0;
    const scene::TerrainSurface* level = nullptr;
    for (const CityPiece& piece : city->pieces) {
        const glm::ivec2 place = piece.begin / tile;
        const bool is_inside = place.x > 0 && place.x < 3 && place.y > 0 && place.y < 3;
        EXPECT_EQ(piece.has_buildings, is_inside) << place.x << ' ' << place.y;
        built += piece.has_buildings ? 1 : 0;
        if (!piece.has_buildings) {
            level = level == nullptr ? piece.surface.get() : level;
            EXPECT_EQ(piece.surface.get(), level);
        }
    }
    EXPECT_EQ(built, 4);
    EXPECT_FALSE(lone_city({.piece = tile, .city = 4, .pieces = 4}));
}

TEST(CutCity, ItsNodesLieWhereTheWholeHasTheirSamples) {
    const auto city = lone_city({.piece = tile, .city = 2, .pieces = 4, .threads = 1});
    ASSERT_TRUE(city);
    const scene::Scene pieces = scene_of_pieces(*city, city->pieces, {}, {});
    const scene::Scene whole = scene_of_pieces(*city, {city->whole}, {}, {});
    for (const double x : {-30.3, -11.1, -0.2, 3.7, 15.9}) {
        for (const double y : {-28.4, -7.6, 0.3, 9.2}) {
            const auto in_pieces = pieces.height_at(x, y);
            const auto in_whole = whole.height_at(x, y);
            ASSERT_TRUE(in_pieces && in_whole);
            EXPECT_NEAR(*in_pieces, *in_whole, 1e-6) << x << ' ' << y;
            EXPECT_NEAR(*in_whole, *city->whole.surface->height_at(x, y), 1e-6) << x << ' ' << y;
        }
    }
}

TEST(CutCity, AHitBelongsToThePieceThatPutsItWhereItIsSeen) {
    const auto city = repeated_city(tile, 2, 1);
    ASSERT_TRUE(city);
    const scene::Camera camera{
        .eye = {0.0, 0.0, 100.0}, .target = {0.0, 0.0, 0.0}, .up = {0, 1, 0}};
    const glm::ivec2 size(9, 9);
    HitBuffer hits(size.x, size.y);
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const Ray ray = scene::view_ray(camera, size, glm::dvec2(x, y) + 0.5);
            const glm::dvec3 seen =
                *city->whole.surface->placement().sample_from_world(ray.at(100.0));
            if (seen.x >= 0 && seen.y >= 0 && seen.x < 2 * tile && seen.y < 2 * tile) {
                hits(x, y) = hit_at({std::fmod(seen.x, tile), std::fmod(seen.y, tile)}, 0.0, 100.0);
            }
        }
    }
    const HitBuffer moved = hits_on_whole(*city, city->pieces, camera, hits);
    int found = 0;
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const Ray ray = scene::view_ray(camera, size, glm::dvec2(x, y) + 0.5);
            const glm::dvec3 seen =
                *city->whole.surface->placement().sample_from_world(ray.at(100.0));
            EXPECT_EQ(moved(x, y).is_sky(), hits(x, y).is_sky());
            if (!moved(x, y).is_sky()) {
                EXPECT_NEAR(moved(x, y).place().x, seen.x, 1e-4);
                EXPECT_NEAR(moved(x, y).place().y, seen.y, 1e-4);
                ++found;
            }
        }
    }
    EXPECT_GT(found, 8);
}

} // namespace
} // namespace reljef::bench
