#include "engine/view/scene_view.h"

#include <algorithm>
#include <optional>

#include "engine/scene/streaming/tile_stream.h"

namespace reljef::view {
namespace {

int count_nodes(const scene::Node& node) {
    int count = 1;
    for (const auto& child : node.children()) {
        count += count_nodes(*child);
    }
    return count;
}

bool shows_something(const scene::Node& node) {
    return node.get<scene::TerrainNode>() != nullptr || node.get<scene::MeshNode>() != nullptr;
}

std::uint64_t revision_of(const scene::Node& node) {
    const auto* const terrain = node.get<scene::TerrainNode>();
    return terrain != nullptr && terrain->stream != nullptr ? terrain->stream->revision() : 0;
}

template <class Value> bool set_value(Value& value, const Value& now) {
    if (value == now) {
        return false;
    }
    value = now;
    return true;
}

bool look_at(SeenNode& seen, const scene::Node& node, const glm::dmat4& world_from_local,
             const scene::Camera& camera) {
    const auto* const mesh = node.get<scene::MeshNode>();
    const scene::Facing facing = mesh != nullptr ? mesh->facing : scene::Facing::node;
    bool is_new = set_value(seen.node, &node);
    is_new =
        set_value(seen.world_from_local, scene::faced(facing, world_from_local, camera)) || is_new;
    is_new = set_value(seen.stream_revision, revision_of(node)) || is_new;
    if (set_value(seen.content, node.content())) {
        seen.local_bounds = node.local_bounds(); // takes long for a mesh
        is_new = true;
    }
    return is_new;
}

} // namespace

bool SceneView::look(const scene::Scene& scene, glm::ivec2 size) {
    bool is_new = set_value(camera_, scene.camera());
    is_new = set_value(size_, size) || is_new;
    is_new = set_value(sun_, scene.sun()) || is_new;
    is_new = set_value(point_lights_, scene.point_lights()) || is_new;
    is_new = set_value(sky_, scene.sky()) || is_new;
    is_new = set_value(eye_dome_, scene.eye_dome()) || is_new;
    is_new = set_value(node_count_, count_nodes(scene.root())) || is_new;
    return look_at_nodes(scene) || is_new;
}

bool SceneView::look_at_nodes(const scene::Scene& scene) {
    bool is_new = false;
    int visible = 0;
    std::size_t shown = 0;
    scene::visit_visible(scene.root(), [&](const scene::Node& node, const glm::dmat4& transform) {
        ++visible;
        if (!shows_something(node)) {
            return;
        }
        if (shown == nodes_.size()) {
            nodes_.emplace_back();
        }
        is_new = look_at(nodes_[shown++], node, transform, camera_) || is_new;
    });
    is_new = set_value(visible_count_, visible) || nodes_.size() != shown || is_new;
    nodes_.resize(shown);
    return is_new;
}

double SceneView::error_bound() const {
    std::optional<double> smallest;
    for (const SeenNode& seen : nodes_) {
        if (const auto* const terrain = seen.node->get<scene::TerrainNode>()) {
            const double bound = scene::error_bound(terrain->material.technique);
            smallest = std::min(smallest.value_or(bound), bound);
        }
    }
    return smallest.value_or(0.0);
}

Box SceneView::bounds() const {
    Box bounds;
    for (const SeenNode& seen : nodes_) {
        bounds.add(transformed(seen.world_from_local, seen.local_bounds));
    }
    return bounds;
}

} // namespace reljef::view
