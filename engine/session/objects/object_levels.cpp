#include "engine/session/objects/object_levels.h"

#include <algorithm>
#include <utility>

#include "engine/scene/levels/mesh_levels.h"

namespace reljef::session {
namespace {

template <class Visit>
void visit_meshes(const std::vector<PlacedObject>& objects, const Visit& visit) {
    for (const PlacedObject& object : objects) {
        for (const auto& part : object.node->children()) {
            if (auto* const mesh = part->get<scene::MeshNode>()) {
                visit(*mesh);
            }
        }
    }
}

bool lacks_levels(const scene::MeshNode& node) {
    return node.levels == nullptr && node.material.detail.set == nullptr &&
           node.mesh->indices.size() / 3 >= scene::min_triangles_with_levels;
}

} // namespace

std::vector<ObjectMesh> meshes_without_levels(const std::vector<PlacedObject>& objects) {
    std::vector<ObjectMesh> meshes;
    visit_meshes(objects, [&](const scene::MeshNode& node) {
        if (lacks_levels(node) && std::ranges::find(meshes, node.mesh) == meshes.end()) {
            meshes.push_back(node.mesh);
        }
    });
    return meshes;
}

Result<std::vector<MadeLevels>> make_levels(const std::vector<ObjectMesh>& meshes,
                                            const ParallelOptions& options) {
    std::vector<MadeLevels> made;
    for (const ObjectMesh& mesh : meshes) {
        auto levels = scene::mesh_levels(*mesh, options);
        if (!levels) {
            return Error{"stopped while levels of detail of objects were made"};
        }
        made.push_back({mesh, std::make_shared<const scene::MeshLevels>(std::move(*levels))});
    }
    return made;
}

void set_levels(const std::vector<PlacedObject>& objects, const std::vector<MadeLevels>& made) {
    visit_meshes(objects, [&](scene::MeshNode& node) {
        const auto found = std::ranges::find(made, node.mesh, &MadeLevels::mesh);
        if (found != made.end() && lacks_levels(node)) {
            node.levels = found->levels;
        }
    });
}

} // namespace reljef::session
