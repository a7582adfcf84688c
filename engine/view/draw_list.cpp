#include "engine/view/draw_list.h"

#include <utility>

namespace reljef::view {

Result<void> check_techniques(const DrawList& list) {
    const scene::TerrainNode* checked = nullptr;
    const auto check_node = [&](const scene::TerrainNode& terrain) -> Result<void> {
        if (std::exchange(checked, &terrain) == &terrain) {
            return {};
        }
        return scene::check_technique(terrain.material.technique, *terrain.surface);
    };
    for (const TileDraw& draw : list.tiles) {
        if (auto good = check_node(*draw.terrain); !good) {
            return good;
        }
    }
    for (const StreamedDraw& draw : list.streamed_tiles) {
        if (auto good = check_node(*draw.terrain); !good) {
            return good;
        }
    }
    for (const ReliefDraw& draw : list.reliefs) {
        if (auto good = check_node(*draw.terrain); !good) {
            return good;
        }
    }
    for (const MeshDraw& draw : list.meshes) {
        if (auto good = scene::check_technique(draw.mesh->material.technique, *draw.mesh); !good) {
            return good;
        }
    }
    return {};
}

std::optional<scene::TerrainLight> light_on(const DrawList& list,
                                            const glm::dmat4& world_from_local) {
    if (!list.sun) {
        return std::nullopt;
    }
    return scene::TerrainLight{*list.sun, glm::dmat3(world_from_local)};
}

} // namespace reljef::view
