#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "engine/core/geometry.h"
#include "engine/scene/graph/scene.h"

namespace reljef::view {

/// A visible terrain or mesh node.
struct SeenNode {
    const scene::Node* node = nullptr;
    glm::dmat4 world_from_local{1.0};
    scene::Node::Content content;
    Box local_bounds;                  ///< metres
    std::uint64_t stream_revision = 0; ///< of the content's tiles; 0: no stream
};

/// Everything that a frame's draw list depends on, by value: equal views give equal lists.
class SceneView {
public:
    SceneView() = default;
    SceneView(const scene::Scene& scene, glm::ivec2 size) { look(scene, size); }

    /// Looks at the scene again; returns whether anything changed.
    bool look(const scene::Scene& scene, glm::ivec2 size);

    [[nodiscard]] const scene::Camera& camera() const { return camera_; }
    [[nodiscard]] glm::ivec2 size() const { return size_; }
    [[nodiscard]] const std::optional<scene::Light>& sun() const { return sun_; }
    [[nodiscard]] const std::vector<scene::PlacedPointLight>& point_lights() const {
        return point_lights_;
    }
    [[nodiscard]] const std::optional<scene::Sky>& sky() const { return sky_; }
    [[nodiscard]] double eye_dome() const { return eye_dome_; }
    [[nodiscard]] const std::vector<SeenNode>& nodes() const { return nodes_; }
    [[nodiscard]] int node_count() const { return node_count_; }
    [[nodiscard]] int visible_count() const { return visible_count_; }
    /// Of all nodes, world metres.
    [[nodiscard]] Box bounds() const;

    /// The smallest error bound of the terrains' techniques, pixels; 0 if one has none, and without
    /// terrain.
    [[nodiscard]] double error_bound() const;

private:
    bool look_at_nodes(const scene::Scene& scene);

    scene::Camera camera_;
    glm::ivec2 size_{0};
    std::optional<scene::Light> sun_;
    std::vector<scene::PlacedPointLight> point_lights_;
    std::optional<scene::Sky> sky_;
    double eye_dome_ = 0.0;
    std::vector<SeenNode> nodes_; // parents first
    int node_count_ = 0;          // visible or not
    int visible_count_ = 0;
};

} // namespace reljef::view
