#pragma once

#include <cmath>
#include <utility>

#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include "engine/scene/graph/scene.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::test {

/// Smooth hills of up to ±`height` metres, a few dozen samples wide.
inline Grid<float> hills(int cols, int rows, double height) {
    return made_heights(cols, rows, [&](int col, int row) {
        return height * (0.6 * std::sin(0.13 * col + 0.4) * std::cos(0.11 * row) +
                         0.4 * std::sin(0.05 * col - 0.07 * row));
    });
}

inline scene::Node& add_terrain(scene::Scene& scene, terrain::Heightfield heightfield,
                                Image color = {}, const scene::TerrainOptions& options = {}) {
    auto node = scene.add_terrain({"made", std::move(heightfield), std::move(color), {}}, options);
    EXPECT_TRUE(node);
    return **node;
}

inline const scene::TerrainSurface& surface_of(const scene::Node& node) {
    return *node.get<scene::TerrainNode>()->surface;
}

inline scene::Camera camera_at(glm::dvec3 eye, glm::dvec3 look) {
    scene::Camera camera;
    camera.eye = eye;
    camera.target = look;
    return camera;
}

} // namespace reljef::test
