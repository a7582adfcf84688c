#include "engine/cast/mesh/mesh_trees.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "engine/truth/mesh_caster.h"
#include "tests/gl/gl_fixture.h"

namespace reljef::cast {
namespace {

constexpr Interval onward{0.0, std::numeric_limits<double>::infinity()};

glm::dvec3 any_direction(std::mt19937& random) {
    std::normal_distribution<double> axis;
    return glm::normalize(glm::dvec3(axis(random), axis(random), axis(random)));
}

// Draws for the tests; owns the nodes.
struct MadeMeshes {
    std::vector<std::unique_ptr<scene::MeshNode>> nodes;
    std::vector<view::MeshDraw> draws;
    scene::Scene scene; // the same, for the truth

    void add(const std::shared_ptr<const scene::Mesh>& mesh, const glm::dmat4& place) {
        nodes.push_back(std::make_unique<scene::MeshNode>(scene::MeshNode{mesh, {}}));
        draws.push_back({nodes.back().get(), place, false});
        scene.root().add("mesh", *nodes.back()).set_parent_from_local(place);
    }
    void add(scene::Mesh mesh, const glm::dmat4& place = glm::dmat4(1.0)) {
        add(std::make_shared<const scene::Mesh>(std::move(mesh)), place);
    }
};

glm::dmat4 placed(glm::dvec3 at, double degrees = 0.0, double scale = 1.0) {
    const glm::dmat4 turned = glm::rotate(glm::translate(glm::dmat4(1.0), at),
                                          glm::radians(degrees), glm::dvec3(1.0, 2.0, 3.0));
    return glm::scale(turned, glm::dvec3(scale));
}

void add_shapes(MadeMeshes& made, glm::dvec3 around) {
    made.add(scene::sphere_mesh(3.0F), placed(around + glm::dvec3(0.0, 0.0, 2.0)));
    made.add(scene::torus_mesh(4.0F, 1.0F), placed(around + glm::dvec3(6.0, 1.0, 0.0), 40.0));
    made.add(scene::box_mesh({2.0F, 3.0F, 4.0F}),
             placed(around + glm::dvec3(-6.0, 2.0, 1.0), 70.0));
    made.add(scene::cylinder_mesh(0.01F, 0.05F),
             placed(around + glm::dvec3(1.0, -6.0, 0.0), 20.0, 100.0));
    made.add(scene::bowl_mesh(2.0F), placed(around + glm::dvec3(2.0, 6.0, 0.0), 10.0, 1.5));
}

// Near the origin and 30 km away from it, where the eye is, too.
TEST(MeshTrees, FindTheHitsOfTheTruth) {
    for (const glm::dvec3 around : {glm::dvec3(0.0), glm::dvec3(30'000.0, -12'000.0, 800.0)}) {
        MadeMeshes made;
        add_shapes(made, around);
        const glm::dvec3 eye = around + glm::dvec3(3.0, -25.0, 8.0);
        MeshTrees trees;
        const PlacedMeshes meshes = test::must(trees.place(made.draws, {}, eye));
        const auto truth = truth::MeshCaster::create(made.scene).value();
        std::mt19937 random(5);
        int hits = 0;
        int others = 0; // a float decides at an outline
        for (int i = 0; i < 20'000; ++i) {
            const glm::dvec3 from = 22.0 * any_direction(random);
            const glm::dvec3 direction = 5.0 * any_direction(random) - from;
            const auto found = meshes.first_hit({around + from - eye, direction}, onward);
            const auto expected = truth.first_hit({around + from, direction}, onward);
            hits += expected ? 1 : 0;
            const bool is_same = found.has_value() == expected.has_value() &&
                                 (!found || std::abs(found->t - expected->t) <= 1e-5);
            others += is_same ? 0 : 1;
            if (found && expected && found->mesh == expected->mesh &&
                found->triangle == expected->triangle) {
                ASSERT_NEAR(found->t, expected->t, 1e-9) << i;
                ASSERT_NEAR(found->shares.x, expected->shares.x, 1e-6) << i;
            }
        }
        EXPECT_GT(hits, 5000);
        EXPECT_LE(others, 4);
    }
}

TEST(MeshTrees, ShowTheOutsideAndHideFromBothSides) {
    MadeMeshes made;
    made.add(scene::plane_mesh({2.0F, 2.0F}));
    MeshTrees trees;
    const PlacedMeshes meshes = test::must(trees.place(made.draws, {}, glm::dvec3(0.0)));
    const glm::dvec3 above(0.3, 0.2, 1.0);
    const glm::dvec3 below(0.3, 0.2, -1.0);
    const glm::dvec3 up(0.0, 0.0, 1.0);
    EXPECT_TRUE(meshes.first_hit({above, -up}, onward));
    EXPECT_FALSE(meshes.first_hit({above, -up}, {0.0, 0.9}));
    EXPECT_FALSE(meshes.first_hit({above, -up}, {1.1, 2.0}));
    EXPECT_FALSE(meshes.first_hit({below, up}, onward));
    EXPECT_TRUE(meshes.hides(glm::vec3(above), glm::vec3(-up)));
    EXPECT_TRUE(meshes.hides(glm::vec3(below), glm::vec3(up)));
    EXPECT_FALSE(meshes.hides(glm::vec3(above), glm::vec3(up)));
}

// Trees may show triangles in any order: the first mesh's first triangle wins.
// As those of maps, whose eye is among what they show.
TEST(MeshTrees, RaysMayHitBeforeTheirOrigin) {
    MadeMeshes made;
    made.add(scene::box_mesh(glm::vec3(2.0F)), placed({0.0, 0.0, 50.0}));
    MeshTrees trees;
    const PlacedMeshes meshes = test::must(trees.place(made.draws, {}, glm::dvec3(0.0)));
    const Ray down{{0.1, 0.2, 0.0}, {0.0, 0.0, -1.0}};
    const auto hit = meshes.first_hit(down, {-1000.0, 1000.0});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->t, -51.0, 1e-9);
    EXPECT_FALSE(meshes.first_hit(down, {-10.0, 1000.0}));
}

TEST(MeshTrees, OfEqualTrianglesTheFirstWins) {
    scene::Mesh twice = scene::plane_mesh({2.0F, 2.0F});
    const std::vector<std::uint32_t> once = twice.indices;
    for (int i = 0; i < 40; ++i) {
        twice.indices.insert(twice.indices.end(), once.begin(), once.end());
    }
    MadeMeshes made;
    const auto mesh = std::make_shared<const scene::Mesh>(twice);
    for (int i = 0; i < 10; ++i) {
        made.add(mesh, glm::dmat4(1.0));
    }
    MeshTrees trees;
    const PlacedMeshes meshes = test::must(trees.place(made.draws, {}, glm::dvec3(0.0)));
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-0.99, 0.99);
    for (int i = 0; i < 1000; ++i) {
        const auto hit =
            meshes.first_hit({{place(random), place(random), 3.0}, {0.0, 0.0, -1.0}}, onward);
        ASSERT_TRUE(hit);
        EXPECT_EQ(hit->mesh, 0U);
        EXPECT_LT(hit->triangle, once.size());
    }
}

TEST(MeshTrees, NoRayLeaksIntoAClosedMesh) {
    MadeMeshes made;
    made.add(scene::sphere_mesh(1.0F, 48), placed({3.0, 1.0, 2.0}, 0.0, 2.0));
    MeshTrees trees;
    const glm::dvec3 eye(3.0, 1.0, 2.0);
    const PlacedMeshes meshes = test::must(trees.place(made.draws, {}, eye));
    const scene::Mesh& mesh = *made.nodes.front()->mesh;
    std::mt19937 random(11);
    for (int i = 0; i < 20'000; ++i) {
        // Towards the middles of edges and corners, where triangles meet.
        const std::size_t first = 3 * (random() % (mesh.indices.size() / 3));
        const glm::dvec3 a(mesh.positions[mesh.indices[first]]);
        const glm::dvec3 b(mesh.positions[mesh.indices[first + 1]]);
        const glm::dvec3 outward = any_direction(random);
        const glm::dvec3 from = 10.0 * outward;
        const glm::dvec3 target = (i % 2 == 0 ? a : 0.5 * (a + b)) * 1.999;
        const auto hit = meshes.first_hit({from, target - from}, onward);
        ASSERT_TRUE(hit) << i;
        ASSERT_GE(glm::length(from + hit->t * (target - from)), 1.9) << i;
    }
}

TEST(MeshTrees, TrianglesWithoutAreaAreNotMet) {
    scene::Mesh mesh = scene::plane_mesh({2.0F, 2.0F});
    mesh.indices.insert(mesh.indices.begin(), {0, 0, 1, 2, 2, 2});
    MadeMeshes made;
    made.add(mesh);
    scene::Mesh nothing = mesh;
    nothing.indices = {0, 0, 1};
    made.add(nothing);
    nothing.indices.clear();
    made.add(nothing);
    MeshTrees trees;
    const PlacedMeshes meshes = test::must(trees.place(made.draws, {}, glm::dvec3(0.0)));
    const auto hit = meshes.first_hit({{0.2, 0.3, 1.0}, {0.0, 0.0, -1.0}}, onward);
    ASSERT_TRUE(hit);
    EXPECT_GE(hit->triangle, 6U);
    EXPECT_DOUBLE_EQ(hit->t, 1.0);
}

TEST(MeshTrees, MeshesScaledToNothingAreNotCast) {
    for (const double scale : {1e-15, 1e-20, 1e-200, 1e-308}) {
        MadeMeshes made;
        made.add(scene::sphere_mesh(1.0F), placed({0.0, 0.0, -50.0}));
        made.add(scene::sphere_mesh(1.0F), placed({0.0, 0.0, -5.0}, 30.0, scale));
        MeshTrees trees;
        const auto meshes = trees.place(made.draws, {}, glm::dvec3(0.0));
        ASSERT_TRUE(meshes) << meshes.error().message;
        const auto hit = meshes->first_hit({glm::dvec3(0.0), {0.0, 0.0, -1.0}}, onward);
        ASSERT_TRUE(hit) << scale;
        EXPECT_NEAR(hit->t, 49.0, 0.1);
    }
}

TEST(MeshTrees, KeepATreeAsLongAsItsMesh) {
    MeshTrees trees;
    {
        MadeMeshes made;
        const auto mesh = std::make_shared<const scene::Mesh>(scene::box_mesh(glm::vec3(1.0F)));
        for (int i = 0; i < 5; ++i) {
            made.add(mesh, placed({2.0 * i, 0.0, 0.0}));
        }
        test::must(trees.place(made.draws, {}, glm::dvec3(0.0)));
        test::must(trees.place(made.draws, {}, glm::dvec3(1.0)));
        EXPECT_EQ(trees.size(), 1U);
    }
    test::must(trees.place({}, {}, glm::dvec3(0.0)));
    EXPECT_EQ(trees.size(), 0U);
}

// Memory that this process has mapped, bytes.
std::size_t mapped_bytes() {
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

// The error of a tree in a process with so many more bytes of memory.
std::string error_within(const MadeMeshes& made, std::size_t bytes) {
    std::array<int, 2> ends{};
    EXPECT_EQ(::pipe(ends.data()), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        MeshTrees trees;
        test::must(trees.place({}, {}, glm::dvec3(0.0))); // Embree has started
        const rlimit limit{mapped_bytes() + bytes, RLIM_INFINITY};
        ::setrlimit(RLIMIT_AS, &limit);
        const auto placed = trees.place(made.draws, {}, glm::dvec3(0.0));
        const std::string said = placed ? "drawn" : placed.error().message;
        ::_exit(::write(ends[1], said.data(), said.size()) < 0 ? 1 : 0);
    }
    ::close(ends[1]);
    std::array<char, 300> said{};
    const ssize_t length = ::read(ends[0], said.data(), said.size());
    ::close(ends[0]);
    int status = 0;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
    return {said.data(), static_cast<std::size_t>(std::max<ssize_t>(length, 0))};
}

TEST(MeshTrees, WithoutMemoryOneSentenceSaysSo) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "the sanitizers need the memory";
#endif
    scene::Mesh mesh = scene::plane_mesh({2.0F, 2.0F});
    const std::vector<std::uint32_t> once = mesh.indices;
    for (int i = 0; i < 500'000; ++i) {
        mesh.indices.insert(mesh.indices.end(), once.begin(), once.end());
    }
    MadeMeshes made;
    made.add(std::move(mesh));
    for (const std::size_t megabytes : {20U, 60U}) {
        EXPECT_EQ(error_within(made, megabytes << 20U),
                  "rays on the CPU: a mesh of 1000002 triangles found, fewer were expected: the "
                  "memory for their tree is missing");
    }
    EXPECT_EQ(error_within(made, std::size_t{4} << 30U), "drawn");
}

} // namespace
} // namespace reljef::cast
