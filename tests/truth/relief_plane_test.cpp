#include "engine/truth/relief_plane.h"

#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/terrain/field/ray_cast.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::truth {
namespace {

constexpr std::array<Border, 3> all_borders{Border::wrap, Border::clamp, Border::discard};

ReliefPlane plane_of(const Grid<float>& tile, const ReliefOptions& options) {
    return ReliefPlane::create(tile.view(), options).value();
}

// What GL samples at a texture coordinate: linear filter, REPEAT or CLAMP_TO_EDGE.
double gl_sample(const Grid<float>& tile, glm::dvec2 coordinate, bool repeat) {
    const glm::dvec2 place = coordinate * glm::dvec2(tile.cols(), tile.rows()) - 0.5;
    const glm::dvec2 low = glm::floor(place);
    const auto texel = [&](double col, double row) {
        const auto wrap = [](double index, int count) {
            return static_cast<int>(index - count * std::floor(index / count));
        };
        return static_cast<double>(
            repeat ? tile(wrap(col, tile.cols()), wrap(row, tile.rows()))
                   : tile.clamped(static_cast<int>(col), static_cast<int>(row)));
    };
    const glm::dvec2 part = place - low;
    const double north = glm::mix(texel(low.x, low.y), texel(low.x + 1.0, low.y), part.x);
    const double south =
        glm::mix(texel(low.x, low.y + 1.0), texel(low.x + 1.0, low.y + 1.0), part.x);
    return glm::mix(north, south, part.y);
}

// The place in metres of a texture coordinate and height.
glm::dvec3 place_of(const ReliefOptions& options, glm::dvec2 coordinate, double height) {
    return options.width * glm::dvec3(coordinate.x - 0.5, 0.5 - coordinate.y,
                                      (height + options.offset) * options.scale);
}

TEST(ReliefPlane, AFlatTileIsMetWhereThePlaneLies) {
    test::Chance chance(41);
    for (const Border border : all_borders) {
        for (int i = 0; i < 1000; ++i) {
            const auto height = static_cast<float>(chance.whole(0, 4)) / 4.0F;
            const ReliefOptions options{chance.between(0.1, 90.0), chance.between(0.01, 2.0),
                                        -chance.between(0.0, 1.0), border};
            const ReliefPlane plane =
                plane_of(Grid<float>(chance.whole(1, 5), chance.whole(1, 5), height), options);
            const glm::dvec2 at(chance.between(0.01, 0.99), chance.between(0.01, 0.99));
            const glm::dvec3 target = place_of(options, at, height);
            const glm::dvec3 way(chance.between(-1.0, 1.0), chance.between(-1.0, 1.0), -1.0);
            // Over a discarded border no ray enters from above the slab but straight enough.
            const Ray ray{target - 2.0 * options.width * options.scale * way, way};
            const auto hit = plane.first_hit(ray);
            const glm::dvec3 enters = target - (1.0 - height) * options.width * options.scale * way;
            const bool from_above =
                std::max(std::abs(enters.x), std::abs(enters.y)) < 0.5 * options.width;
            if (border == Border::discard && !from_above) {
                continue;
            }
            ASSERT_TRUE(hit) << i;
            ASSERT_NEAR(hit->t, 2.0 * options.width * options.scale, 1e-9 * options.width);
            ASSERT_LE(glm::distance(hit->texture_coordinate, at), 1e-9);
            ASSERT_NEAR(hit->height, height, 1e-9);
        }
    }
}

TEST(ReliefPlane, SeenFromAboveItIsWhatGlSamples) {
    test::Chance chance(42);
    for (const Border border : all_borders) {
        for (unsigned field = 0; field < 20; ++field) {
            const Grid<float> tile =
                test::random_heights(chance.whole(1, 9), chance.whole(1, 9), 0.0F, 1.0F, field);
            const ReliefOptions options{3.0, 0.2, -0.5, border};
            const ReliefPlane plane = plane_of(tile, options);
            const bool repeat = border == Border::wrap;
            for (int i = 0; i < 500; ++i) {
                const glm::dvec2 at(chance.between(-2.5, 3.5), chance.between(-2.5, 3.5));
                const bool on_tile = at.x > 0.0 && at.y > 0.0 && at.x < 1.0 && at.y < 1.0;
                const auto hit = plane.first_hit({place_of(options, at, 5.0), {0.0, 0.0, -1.0}});
                ASSERT_EQ(hit.has_value(), border != Border::discard || on_tile);
                if (hit) {
                    const glm::dvec2 coordinate =
                        repeat ? at - glm::floor(at) : glm::clamp(at, 0.0, 1.0);
                    ASSERT_LE(glm::distance(hit->texture_coordinate, coordinate), 1e-9);
                    ASSERT_NEAR(hit->height, gl_sample(tile, at, repeat), 1e-9);
                }
            }
        }
    }
}

// Many copies, or many of the border's texels, written out into one large heightfield.
void expect_as_written_out(Border border) {
    constexpr int copies = 9;
    test::Chance chance(43);
    int hits = 0;
    for (unsigned field = 0; field < 12; ++field) {
        const Grid<float> tile =
            test::random_heights(chance.whole(1, 8), chance.whole(1, 8), 0.0F, 1.0F, field);
        const int before = copies / 2;
        const Grid<float> large = test::made_heights(
            copies * tile.cols() + 1, copies * tile.rows() + 1, [&](int col, int row) {
                return border == Border::wrap
                           ? tile(col % tile.cols(), row % tile.rows())
                           : tile.clamped(col - before * tile.cols(), row - before * tile.rows());
            });
        const terrain::MinMaxPyramid pyramid(large.view());
        const ReliefOptions options{2.0, 0.3, -1.0, border};
        const ReliefPlane plane = plane_of(tile, options);
        const auto on_large = [&](glm::dvec3 place) {
            const glm::dvec2 coordinate(place.x / 2.0 + 0.5, 0.5 - place.y / 2.0);
            return glm::dvec3((coordinate + static_cast<double>(before)) *
                                      glm::dvec2(tile.cols(), tile.rows()) -
                                  0.5,
                              place.z / 0.6 + 1.0);
        };
        for (int i = 0; i < 3000; ++i) {
            const glm::dvec3 from(chance.between(-7.0, 7.0), chance.between(-7.0, 7.0),
                                  chance.between(-0.3, 1.0));
            const glm::dvec3 to(chance.between(-7.0, 7.0), chance.between(-7.0, 7.0),
                                chance.between(-1.0, 0.0));
            const auto expected = terrain::first_hit(
                large.view(), pyramid, {on_large(from), on_large(to) - on_large(from)}, {0.0, 1.0});
            const auto hit = plane.first_hit({from, to - from}, {0.0, 1.0});
            ASSERT_EQ(hit.has_value(), expected.has_value()) << field << ' ' << i;
            if (hit) {
                ++hits;
                ASSERT_NEAR(hit->t, expected->t, 1e-9);
                ASSERT_NEAR(hit->height, expected->sample.z, 1e-9);
            }
        }
    }
    EXPECT_GT(hits, 10000);
}

TEST(ReliefPlane, WrappedIsTheTileWrittenOutManyTimes) {
    expect_as_written_out(Border::wrap);
}

TEST(ReliefPlane, ClampedIsTheTileWithItsBorderDrawnOut) {
    expect_as_written_out(Border::clamp);
}

TEST(ReliefPlane, DiscardedIsTheClampedTileOverTheTileAlone) {
    test::Chance chance(44);
    const Grid<float> tile = test::random_heights(6, 5, 0.0F, 1.0F, 3);
    const ReliefPlane clamped = plane_of(tile, {2.0, 0.3, -1.0, Border::clamp});
    const ReliefPlane discarded = plane_of(tile, {2.0, 0.3, -1.0, Border::discard});
    const Box box{{-1.0, -1.0, -9.0}, {1.0, 1.0, 9.0}};
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const glm::dvec3 from(chance.between(-2.0, 2.0), chance.between(-2.0, 2.0),
                              chance.between(0.01, 1.0));
        const glm::dvec3 to(chance.between(-2.0, 2.0), chance.between(-2.0, 2.0),
                            chance.between(-1.0, 0.0));
        const Ray ray{from, to - from};
        const auto over = intersect(ray, box, {0.0, 1.0});
        const auto expected = over ? clamped.first_hit(ray, *over) : std::nullopt;
        const auto hit = discarded.first_hit(ray, {0.0, 1.0});
        ASSERT_EQ(hit.has_value(), expected.has_value()) << i;
        if (hit) {
            ++hits;
            ASSERT_NEAR(hit->t, expected->t, 1e-9);
        }
    }
    EXPECT_GT(hits, 2000);
}

TEST(ReliefPlane, WrappedIsTheSameACopyFarther) {
    test::Chance chance(45);
    const Grid<float> tile = test::random_heights(16, 16, 0.0F, 1.0F, 4);
    const ReliefPlane plane = plane_of(tile, {2.0, 0.2, -0.3, Border::wrap});
    for (int i = 0; i < 5000; ++i) {
        const Ray ray{{chance.between(-1.0, 1.0), chance.between(-1.0, 1.0), 0.5},
                      {chance.between(-3.0, 3.0), chance.between(-3.0, 3.0), -1.0}};
        const glm::dvec3 shift(2.0 * chance.whole(-40, 40), 2.0 * chance.whole(-40, 40), 0.0);
        const auto here = plane.first_hit(ray);
        const auto there = plane.first_hit({ray.origin + shift, ray.direction});
        ASSERT_TRUE(here && there);
        ASSERT_NEAR(here->t, there->t, 1e-9);
        // The same place on the ring of coordinates.
        const glm::dvec2 off = glm::abs(here->texture_coordinate - there->texture_coordinate);
        ASSERT_LE(std::min(off.x, 1.0 - off.x), 1e-9);
        ASSERT_LE(std::min(off.y, 1.0 - off.y), 1e-9);
        ASSERT_GE(there->texture_coordinate.x, 0.0);
        ASSERT_LT(there->texture_coordinate.x, 1.0);
    }
}

// At the surface itself, on the lines where one copy, or the border drawn out, follows the other.
TEST(ReliefPlane, NoRayFromAbovePassesThroughTheSeams) {
    test::Chance chance(46);
    const Grid<float> tile = test::random_heights(5, 7, 0.0F, 1.0F, 5);
    for (const Border border : {Border::wrap, Border::clamp}) {
        const ReliefOptions options{1.0, 0.5, -1.0, border};
        const ReliefPlane plane = plane_of(tile, options);
        for (int i = 0; i < 100000; ++i) {
            glm::dvec2 texel(chance.whole(-2, 2) * 5, chance.whole(-2, 2) * 7);
            texel[chance.whole(0, 1)] += chance.one_in(2) ? chance.between(-9.0, 9.0) : 0.0;
            const glm::dvec2 at = (texel + 0.5) / glm::dvec2(5.0, 7.0);
            const double height = gl_sample(tile, at, border == Border::wrap);
            const glm::dvec3 way(chance.one_in(3) ? 0.0 : chance.between(-2.0, 2.0),
                                 chance.one_in(3) ? 0.0 : chance.between(-2.0, 2.0), -1.0);
            ASSERT_TRUE(plane.first_hit({place_of(options, at, height) - way, way})) << i;
        }
    }
}

TEST(ReliefPlane, GrazingRaysEndAndFindWhatIsThere) {
    Grid<float> tile(64, 64, 0.0F);
    tile(32, 32) = 1.0F;
    for (const Border border : all_borders) {
        const ReliefPlane plane = plane_of(tile, {1.0, 0.1, -1.0, border});
        // Straight towards the spike, ever flatter.
        for (const double slope : {1e-1, 1e-3, 1e-6, 1e-9, 1e-12, 0.0}) {
            const double y = 0.5 - 32.5 / 64.0;
            const auto hit =
                plane.first_hit({{-0.45, y, -0.05 + 0.45 * slope}, {1.0, 0.0, -slope}});
            ASSERT_TRUE(hit) << slope;
            EXPECT_NEAR(hit->texture_coordinate.x, 32.0 / 64.0, 1e-3);
            EXPECT_NEAR(hit->height, 0.5, 0.1 * slope + 1e-2);
        }
        // Past all spikes it may go on for ever; it ends.
        const glm::dvec3 beside(-0.45, -0.3, -0.05);
        for (const glm::dvec3 way : {glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.0, -1.0, 1e-15),
                                     glm::dvec3(0.0), glm::dvec3(1e-320, 1e-320, 0.0)}) {
            EXPECT_FALSE(plane.first_hit({beside, way}));
        }
        const auto far = plane.first_hit({beside, {1.0, 0.0, -1e-12}});
        ASSERT_EQ(far.has_value(), border == Border::clamp) << "on the border's level ground";
        if (far) {
            EXPECT_NEAR(far->t, 0.05e12, 1.0);
        }
    }
}

TEST(ReliefPlane, ExtremeScalesGiveNumbers) {
    test::Chance chance(47);
    const Grid<float> tile = test::random_heights(9, 9, 0.0F, 1.0F, 6);
    for (const Border border : all_borders) {
        for (const double scale : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
            const ReliefPlane plane = plane_of(tile, {10.0, scale, -1.0, border});
            int hits = 0;
            for (int i = 0; i < 500; ++i) {
                const glm::dvec3 eye(chance.between(-4.0, 4.0), chance.between(-4.0, 4.0),
                                     20.0 * scale);
                const glm::dvec3 foot(chance.between(-4.0, 4.0), chance.between(-4.0, 4.0),
                                      -20.0 * scale);
                if (const auto hit = plane.first_hit({eye, foot - eye})) {
                    ++hits;
                    ASSERT_TRUE(std::isfinite(hit->t));
                    ASSERT_NEAR(hit->height,
                                gl_sample(tile, hit->texture_coordinate, border == Border::wrap),
                                1e-9);
                }
            }
            EXPECT_EQ(hits, 500) << scale;
        }
    }
}

TEST(ReliefPlane, RefusesWhatIsNoTileAndNoRelief) {
    const Grid<float> tile(2, 2, 0.5F);
    const auto message = [](const Result<ReliefPlane>& made) {
        return made ? "" : made.error().message;
    };
    using testing::StartsWith;
    EXPECT_THAT(message(ReliefPlane::create({}, {})), StartsWith("relief tile: it has no texels"));
    EXPECT_THAT(message(ReliefPlane::create(Grid<float>(2, 2, 1.5F).view(), {})),
                StartsWith("relief tile: has a height of 1.5"));
    EXPECT_FALSE(
        ReliefPlane::create(Grid<float>(2, 2, std::numeric_limits<float>::quiet_NaN()).view(), {}));
    EXPECT_THAT(message(ReliefPlane::create(tile.view(), {0.0, 0.1, -1.0, Border::wrap})),
                StartsWith("relief width 0"));
    EXPECT_THAT(message(ReliefPlane::create(tile.view(), {1.0, -0.1, -1.0, Border::wrap})),
                StartsWith("relief scale -0.1"));
    EXPECT_THAT(message(ReliefPlane::create(tile.view(), {1.0, 0.1, 0.5, Border::wrap})),
                StartsWith("relief offset 0.5"));
}

TEST(ReliefPlane, RaysThatAreNoNumbersMeetNothing) {
    const ReliefPlane plane = plane_of(Grid<float>(3, 3, 0.5F), {});
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(plane.first_hit({{nan, 0.0, 1.0}, {0.0, 0.0, -1.0}}));
    EXPECT_FALSE(plane.first_hit({{0.0, 0.0, 1.0}, {0.0, nan, -1.0}}));
}

} // namespace
} // namespace reljef::truth
