#include "bench/baselines/triangle_methods.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/baselines/greedy_triangulation.h"
#include "tests/bench/bench_program.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

Grid<float> chance_heights(int cols, int rows, std::mt19937& random) {
    Grid<float> heights(cols, rows);
    for (float& height : heights.samples()) {
        height = std::uniform_real_distribution(0.0F, 100.0F)(random);
    }
    return heights;
}

Grid<float> rough_hills(int side, std::mt19937& random) {
    Grid<float> heights = chance_heights(side, side, random);
    for (int row = 0; row < side; ++row) {
        for (int col = 0; col < side; ++col) {
            heights(col, row) =
                0.02F * heights(col, row) +
                static_cast<float>(30.0 * std::sin(0.13 * col) * std::cos(0.2 * row));
        }
    }
    return heights;
}

std::int64_t doubled_area(const terrain::SampleTriangle& t) {
    return static_cast<std::int64_t>(t[1].x - t[0].x) * (t[2].y - t[0].y) -
           static_cast<std::int64_t>(t[1].y - t[0].y) * (t[2].x - t[0].x);
}

// By floats of the circle's middle, as no code that is tested does.
bool holds_in_circle(const terrain::SampleTriangle& t, glm::ivec2 place) {
    const glm::dvec2 a(t[0]);
    const glm::dvec2 b = glm::dvec2(t[1]) - a;
    const glm::dvec2 c = glm::dvec2(t[2]) - a;
    const double d = 2.0 * (b.x * c.y - b.y * c.x);
    const double bb = b.x * b.x + b.y * b.y;
    const double cc = c.x * c.x + c.y * c.y;
    const glm::dvec2 middle{(c.y * bb - b.y * cc) / d, (b.x * cc - c.x * bb) / d};
    const glm::dvec2 to_place = glm::dvec2(place) - a - middle;
    const double far = std::sqrt(middle.x * middle.x + middle.y * middle.y);
    return std::sqrt(to_place.x * to_place.x + to_place.y * to_place.y) < far * (1.0 - 1e-9);
}

TEST(GreedyTriangulation, CoversOnceKeepsItsErrorAndIsDelaunay) {
    std::mt19937 random(3);
    for (int round = 0; round < 60; ++round) {
        const int cols = std::uniform_int_distribution(2, 14)(random);
        const int rows = std::uniform_int_distribution(2, 14)(random);
        const Grid<float> heights = chance_heights(cols, rows, random);
        const double error = std::uniform_real_distribution(0.0, 60.0)(random);
        const auto triangles = greedy_triangulation(heights.view(), error);
        std::int64_t area = 0;
        for (const terrain::SampleTriangle& triangle : triangles) {
            ASSERT_LT(doubled_area(triangle), 0);
            area -= doubled_area(triangle);
            // Heights to 100 m in doubles.
            EXPECT_LE(farthest_sample(heights.view(), triangle).error, error + 1e-10);
            for (const terrain::SampleTriangle& other : triangles) {
                ASSERT_TRUE(std::none_of(other.begin(), other.end(), [&](glm::ivec2 corner) {
                    return holds_in_circle(triangle, corner);
                }));
            }
        }
        EXPECT_EQ(area, 2 * (cols - 1) * (rows - 1));
    }
}

TEST(GreedyTriangulation, APlaneTakesTwoTrianglesAndASpikeAFew) {
    Grid<float> heights(20, 30);
    for (int row = 0; row < 30; ++row) {
        for (int col = 0; col < 20; ++col) {
            heights(col, row) = static_cast<float>(2 * col - 3 * row);
        }
    }
    EXPECT_EQ(greedy_triangulation(heights.view(), 0.001).size(), 2U);
    heights(7, 11) += 100.0F;
    const auto triangles = greedy_triangulation(heights.view(), 0.001);
    EXPECT_GE(triangles.size(), 8U);
    EXPECT_LE(triangles.size(), 24U);
}

TEST(TriangleMethods, AllButRtinKeepTheError) {
    std::mt19937 random(5);
    for (int round = 0; round < 6; ++round) {
        const Grid<float> heights = rough_hills(65, random);
        for (const TriangleMethod method : all_triangle_methods) {
            const MethodResult result = triangulate_by(method, heights, 4.0);
            EXPECT_GT(result.triangles, 2U);
            if (method == TriangleMethod::rtin) {
                EXPECT_GT(result.worst, 4.0);
            } else {
                // Errors are kept as floats.
                EXPECT_LE(result.worst, 4.0 * (1.0 + 0x1p-20)) << to_string(method);
            }
        }
    }
}

TEST(TriangleMethods, WithoutAnErrorEachHasEverySample) {
    std::mt19937 random(8);
    const Grid<float> heights = chance_heights(17, 17, random);
    for (const TriangleMethod method : {TriangleMethod::rtin, TriangleMethod::patches}) {
        const MethodResult result = triangulate_by(method, heights, 1e-9);
        EXPECT_EQ(result.triangles, 512U) << to_string(method);
        EXPECT_EQ(result.worst, 0.0);
    }
}

TEST(BenchLod, MethodsAreCountedAndWritten) {
    const test::TemporaryFolder folder;
    std::string dem = "ncols 33\nnrows 33\nxllcorner 0\nyllcorner 0\ncellsize 10\n";
    for (int i = 0; i < 33 * 33; ++i) {
        dem += std::to_string(20.0 * std::sin(0.3 * (i % 33)) * std::cos(0.006 * i)) + ' ';
    }
    const auto json = folder.path() / "methods.json";
    const auto result =
        test::reljef_bench({"lod", "--methods", "--terrain", folder.write("dem.asc", dem).string(),
                            "--quiet", "--json", json.string()});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto report = nlohmann::json::parse(test::read_bytes(json));
    EXPECT_EQ(report.at("rows").size(), 12U);
    for (const auto& row : report.at("rows")) {
        EXPECT_EQ(row.at("side"), 33);
        EXPECT_THAT(result.out, testing::HasSubstr(row.at("method").get<std::string>()));
    }
}

TEST(BenchLod, MethodsOfALevelTerrainAreOneLine) {
    const test::TemporaryFolder folder;
    std::string dem = "ncols 17\nnrows 17\nxllcorner 0\nyllcorner 0\ncellsize 10\n";
    for (int i = 0; i < 17 * 17; ++i) {
        dem += "5 ";
    }
    const auto result = test::reljef_bench(
        {"lod", "--methods", "--terrain", folder.write("dem.asc", dem).string(), "--quiet"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, testing::HasSubstr("all heights are 5 m"));
    EXPECT_EQ(test::reljef_bench({"lod", "--methods", "--poses", "3"}).exit_code, 2);
}

} // namespace
} // namespace reljef::bench
