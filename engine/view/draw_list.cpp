#include "engine/view/draw_list.h"

#include <utility>

namespace reljef::view {

Result<void> check_techniques(const DrawList& list) {
    Result<void> checked;
    const scene::TerrainNode* last = nullptr;
    const auto check_terrains = [&](const auto& draws) {
        for (const auto& draw : draws) {
            if (checked && std::exchange(last, draw.terrain) != draw.terrain) {
                const scene::TerrainNode& node = *draw.terrain;
                checked = scene::check_technique(node.material.technique, *node.surface);
            }
        }
    };
    check_terrains(list.tiles);
    check_terrains(list.streamed_tiles);
    check_terrains(list.reliefs);
    for (const MeshDraw& draw : list.meshes) {
        if (checked) {
            checked = scene::check_technique(draw.mesh->material.technique, *draw.mesh);
        }
    }
    return checked;
}

std::optional<scene::TerrainLight> light_on(const DrawList& list,
                                            const glm::dmat4& world_from_local) {
    if (!list.sun) {
        return std::nullopt;
    }
    return scene::TerrainLight{*list.sun, glm::dmat3(world_from_local)};
}

} // namespace reljef::view
