// Vertices that rise to their places.
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/release_only.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/made_bisection.h"

namespace reljef::terrain {
namespace {

using test::PlacedTerrain;

constexpr double first_rise = 0.5;

// A metre of error is a pixel everywhere.
ErrorView rising_view(double max_error, double morph_from = first_rise) {
    ErrorView view;
    view.perspective = false;
    view.max_error = max_error;
    view.morph_from = morph_from;
    return view;
}

// From an eye over the middle, which sees all around.
ErrorView view_around(glm::dvec3 eye) {
    ErrorView view;
    view.morph_from = first_rise;
    view.scale = 300.0;
    view.depth = {0.0, 0.0, -1.0, eye.z};
    view.near = 0.01;
    view.lateral_origin = -eye;
    view.lateral_axes[2][2] = 0.0;
    return view;
}

std::vector<Triangulation> all_parts(const PlacedTerrain& made, const ErrorView& view) {
    std::vector<Triangulation> parts;
    for (const TileCells& tile : made.tiles) {
        for (Triangulation& part : triangulate(made.bisection, tile, view).parts) {
            parts.push_back(std::move(part));
        }
    }
    return parts;
}

double cross_of(glm::dvec2 a, glm::dvec2 b) {
    return a.x * b.y - a.y * b.x;
}

// Offsets of the drawn surface from the true one at places, metres: straight up on a plane.
class DrawnSurface {
public:
    DrawnSurface(const PlacedTerrain& made, const ErrorView& view)
        : made_(made), parts_(all_parts(made, view)) {}

    [[nodiscard]] double error_at(glm::dvec2 steps) const {
        for (const Triangulation& part : parts_) {
            for (std::size_t i = 0; i < part.indices.size(); i += 3) {
                if (const auto height = height_in(part, i, steps)) {
                    return *height - ground_at(steps);
                }
            }
        }
        ADD_FAILURE() << "a place without a triangle";
        return 0.0;
    }

private:
    [[nodiscard]] std::optional<double> height_in(const Triangulation& part, std::size_t first,
                                                  glm::dvec2 place) const {
        std::array<glm::dvec2, 3> at;
        std::array<double, 3> heights{};
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t vertex = part.indices[first + i];
            at[i] = glm::dvec2(part.vertices[vertex]);
            heights[i] = made_.bisection.world(part.vertices[vertex]).z +
                         (part.moves.empty() ? 0.0 : part.moves[vertex].offset.z);
        }
        const double area = cross_of(at[1] - at[0], at[2] - at[0]);
        const double u = cross_of(at[1] - place, at[2] - place) / area;
        const double v = cross_of(at[2] - place, at[0] - place) / area;
        return u < 0.0 || v < 0.0 || u + v > 1.0
                   ? std::nullopt
                   : std::optional(u * heights[0] + v * heights[1] + (1.0 - u - v) * heights[2]);
    }

    [[nodiscard]] double ground_at(glm::dvec2 steps) const {
        const glm::dvec2 sample = steps / static_cast<double>(steps_per_sample);
        const double height = bilinear_height(made_.heightfield.heights.view(), sample);
        return made_.placement.world_from_sample({sample, height}).z;
    }

    const PlacedTerrain& made_;
    std::vector<Triangulation> parts_;
};

std::vector<glm::dvec2> places_of(const PlacedTerrain& made, int count, unsigned seed) {
    test::Chance chance(seed);
    const glm::dvec2 end(made.bisection.end());
    std::vector<glm::dvec2> places;
    places.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        places.emplace_back(chance.between(0.0, end.x), chance.between(0.0, end.y));
    }
    return places;
}

PlacedTerrain hill_terrain(unsigned seed, double exaggeration = 1.0) {
    return PlacedTerrain({"hills",
                          test::plane_heightfield(test::rough_hills(41, 53, seed), {3.0, 4.0}),
                          exaggeration});
}

TEST(BisectionMorph, NoPointIsFartherOffThanTheViewAllows) {
    for (const double most : {2.0, 9.0, 30.0}) {
        const PlacedTerrain terrain = hill_terrain(1, 1.5);
        const DrawnSurface drawn(terrain, rising_view(most));
        double worst = 0.0;
        for (const glm::dvec2 place : places_of(terrain, 150, 2)) {
            worst = std::max(worst, std::abs(drawn.error_at(place)));
        }
        EXPECT_LE(worst, most);
        EXPECT_GT(worst, 0.1 * most);
    }
}

// Where the most error changes by a share e, the errors between f E and E that the surface is the
// mean over are others for a share of at most 2 e / (1 - f); each is within E of the ground.
TEST(BisectionMorph, TheSurfaceFollowsTheViewWithoutAStep) {
    const PlacedTerrain terrain = hill_terrain(3);
    const auto places = places_of(terrain, 40, 4);
    constexpr double change = 1e-3;
    double most = 16.0;
    for (int i = 0; i < 8; ++i) {
        const double next = most * (1.0 - change);
        const DrawnSurface before(terrain, rising_view(most));
        const DrawnSurface after(terrain, rising_view(next));
        for (const glm::dvec2 place : places) {
            EXPECT_LE(std::abs(after.error_at(place) - before.error_at(place)),
                      2.0 * most * 2.0 * change / (1.0 - first_rise) / (1.0 - change));
        }
        most *= 0.7;
    }
}

TEST(BisectionMorph, AFlightMovesNothingFartherThanItsStepsAreLong) {
    RELJEF_RELEASE_ONLY("many surfaces by the lines of the other tests");
    const PlacedTerrain terrain = hill_terrain(5);
    const auto places = places_of(terrain, 40, 6);
    const auto greatest_move = [&](double step) {
        double greatest = 0.0;
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 eye(40.0 * i - 50.0, 20.0 * i, 90.0 + 8.0 * i);
            const DrawnSurface before(terrain, view_around(eye));
            const DrawnSurface after(terrain, view_around(eye + step * glm::dvec3(0.6, 0.0, 0.8)));
            for (const glm::dvec2 place : places) {
                greatest =
                    std::max(greatest, std::abs(after.error_at(place) - before.error_at(place)));
            }
        }
        return greatest;
    };
    const double far = greatest_move(0.08);
    EXPECT_GT(far, 0.0);
    EXPECT_LT(greatest_move(0.01), 0.25 * far);
    EXPECT_LT(greatest_move(1e-5), 1e-3 * far);
}

void expect_moved_alike(const PlacedTerrain& terrain) {
    std::map<std::pair<std::int64_t, std::int64_t>, VertexMove> moves;
    int met_and_moved = 0;
    for (const Triangulation& part : all_parts(terrain, rising_view(3.0))) {
        ASSERT_EQ(part.moves.size(), part.vertices.size());
        for (std::size_t i = 0; i < part.vertices.size(); ++i) {
            const Steps place = part.vertices[i];
            const auto [entry, is_new] = moves.try_emplace({place.x, place.y}, part.moves[i]);
            ASSERT_EQ(entry->second, part.moves[i]) << place.x << ' ' << place.y;
            met_and_moved += !is_new && part.moves[i] != VertexMove{} ? 1 : 0;
        }
    }
    EXPECT_GT(met_and_moved, 5);
}

TEST(BisectionMorph, TilesThatMeetMoveTheirVerticesAlike) {
    const PlacedTerrain plane(
        {"", test::plane_heightfield(test::rough_hills(300, 290, 7), {3.0, 3.0})});
    expect_moved_alike(plane);
    EXPECT_EQ(test::open_edges(plane, test::all_triangles(plane, rising_view(3.0))), 0U);
    expect_moved_alike(PlacedTerrain(
        {"", test::geographic_heightfield(test::rough_hills(300, 290, 7), 46.0, 7.0, 1e-3)}));
}

TEST(BisectionMorph, WithoutItNothingMoves) {
    for (const Triangulation& part : all_parts(hill_terrain(8), rising_view(3.0, 1.0))) {
        EXPECT_TRUE(part.moves.empty());
    }
}

} // namespace
} // namespace reljef::terrain
