#include "engine/scene/graph/text_mesh.h"

#include <array>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace reljef::scene {
namespace {

double area_of(const Mesh& mesh) {
    double area = 0.0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const TriangleEdges edges = triangle_edges(mesh, i);
        const glm::dvec3 across = glm::cross(edges.p, edges.q);
        EXPECT_LT(across.y, 0.0) << "is read from -y";
        area += 0.5 * glm::length(across);
    }
    return area;
}

bool is_same(const Mesh& a, const Mesh& b) {
    return a.positions == b.positions && a.indices == b.indices;
}

// Rows of '#' from the dots' middles.
std::array<std::string, 7> dots_of(char character) {
    const Mesh mesh = text_mesh(std::string(1, character), 7.0F);
    std::array<std::string, 7> rows;
    for (int row = 0; row < 7; ++row) {
        for (int col = 0; col < 5; ++col) {
            const glm::dvec2 place(col - 2.0, 6.5 - row);
            bool is_set = false;
            for (std::size_t i = 0; i < mesh.indices.size(); i += 6) {
                const glm::vec3 low = mesh.positions[mesh.indices[i]];
                const glm::vec3 high = mesh.positions[mesh.indices[i + 2]];
                is_set = is_set || (place.x > low.x && place.x < high.x && place.y > low.z &&
                                    place.y < high.z);
            }
            rows[static_cast<std::size_t>(row)] += is_set ? '#' : '.';
        }
    }
    return rows;
}

TEST(TextMesh, LettersLookLikeLetters) {
    EXPECT_EQ(dots_of('L'), (std::array<std::string, 7>{"#....", "#....", "#....", "#....", "#....",
                                                        "#....", "#####"}));
    EXPECT_EQ(dots_of('R'), (std::array<std::string, 7>{"####.", "#...#", "#...#", "####.", "#.#..",
                                                        "#..#.", "#...#"}));
    EXPECT_EQ(dots_of('j')[6], ".##..");
}

TEST(TextMesh, HasAsManyDotsAsTheFont) {
    EXPECT_NEAR(area_of(text_mesh("I", 14.0F)), 11.0 * 4.0, 1e-4);
    EXPECT_NEAR(area_of(text_mesh("II", 14.0F)), 22.0 * 4.0, 1e-4);
    EXPECT_TRUE(text_mesh("", 1.0F).indices.empty());
    EXPECT_TRUE(text_mesh(" ", 1.0F).indices.empty());
    for (char character = '!'; character <= '~'; ++character) {
        const Mesh mesh = text_mesh(std::string(1, character), 7.0F);
        EXPECT_FALSE(mesh.indices.empty()) << character;
        EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
        EXPECT_EQ(mesh.texture_coordinates.size(), mesh.positions.size());
        (void)area_of(mesh);
    }
}

TEST(TextMesh, LinesAreCentredAndTheLastOneStandsOnTheGround) {
    const Box one = bounds_of(text_mesh("HHH", 7.0F));
    EXPECT_EQ(one.low, glm::dvec3(-8.5, 0.0, 0.0));
    EXPECT_EQ(one.high, glm::dvec3(8.5, 0.0, 7.0));
    const Box two = bounds_of(text_mesh("H\nHHH", 7.0F));
    EXPECT_EQ(two.low, glm::dvec3(-8.5, 0.0, 0.0));
    EXPECT_EQ(two.high, glm::dvec3(8.5, 0.0, 17.0));
}

TEST(TextMesh, OtherCharactersAreQuestionMarks) {
    EXPECT_TRUE(is_same(text_mesh("Kr\xC4\x8Dka", 2.0F), text_mesh("Kr?ka", 2.0F)));
    EXPECT_TRUE(is_same(text_mesh("a\tb\x7F", 2.0F), text_mesh("a?b?", 2.0F)));
    EXPECT_TRUE(is_same(text_mesh("\xF0\x9F\x8F\x94", 2.0F), text_mesh("?", 2.0F)));
}

} // namespace
} // namespace reljef::scene
