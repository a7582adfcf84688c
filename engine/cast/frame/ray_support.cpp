#include "engine/cast/frame/ray_support.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "engine/cast/frame/ground_detail.h"
#include "engine/cast/frame/seen_terrain.h"
#include "engine/cast/frame/sun_light.h"
#include "engine/scene/streaming/tile_stream.h"

namespace reljef::cast {

bool draws_technique(const scene::Technique& technique) {
    scene::TechniqueOptions drawn;
    drawn.depth = technique.options.depth; // rays always order by depth
    if (technique.options.shadow) {
        drawn.shadow = scene::Shadow{.depth = 0.0};
    }
    return technique.options == drawn &&
           (technique.id() == scene::TechniqueId::exact || scene::error_bound(technique) > 0.0);
}

std::string obstacle_of(const scene::TerrainNode& terrain, const scene::Technique& technique) {
    if (!draws_technique(technique)) {
        return fmt::format("technique {}", scene::to_string(technique));
    }
    const bool is_stretched =
        terrain.stream != nullptr && terrain.stream->maker().rows().wrap().rows() > 0;
    if (is_stretched && !is_curved(terrain)) {
        return "a streamed globe on a plane";
    }
    if (is_curved(terrain) && terrain.surface->placement().columns_all_around() &&
        technique.options.shadow) {
        return "a globe with shadows";
    }
    if (terrain.material.shader != nullptr) {
        return "a surface shader";
    }
    if (terrain.material.wireframe) {
        return "a wireframe";
    }
    const double samples = static_cast<double>(terrain.surface->heightfield().heights.size());
    if (samples > std::numeric_limits<std::int32_t>::max()) {
        return "a terrain of more than 2^31 samples";
    }
    if (view::has_detail(terrain) && !draws_detail(terrain.detail->technique)) {
        return fmt::format("a detail texture with technique {}",
                           scene::to_string(terrain.detail->technique));
    }
    return {};
}

std::string obstacle_of(const scene::MeshNode& mesh) {
    const scene::Material& material = mesh.material;
    if (material.shader != nullptr) {
        return "a surface shader";
    }
    if (material.wireframe) {
        return "a wireframe";
    }
    if (material.detail.set == nullptr) {
        return {};
    }
    if (material.technique.id() != scene::TechniqueId::texture) {
        return fmt::format("a mesh with technique {}", scene::to_string(material.technique));
    }
    return scene::visible_detail(material).border == material::WrapMode::wrap &&
                   !scene::is_seen_from_behind(material)
               ? std::string()
               : "a mesh whose texture ends or is seen from behind";
}

namespace {

// Of what is seen of a terrain.
std::string obstacle_in_view(const view::DrawList& list, const SeenTerrain& terrain) {
    if (auto found = obstacle_of(*terrain.node, terrain.node->material.technique); !found.empty()) {
        return found;
    }
    if (terrain.is_from_below) {
        return "a globe from below its ground";
    }
    if (is_curved(*terrain.node) && casts_shadows(terrain) && bends_too_much(list, terrain)) {
        return "a sun whose rays bend too much over so large a terrain, or so near to a pole";
    }
    return {};
}

std::string obstacle_among(const view::DrawList& list, const std::vector<SeenTerrain>& terrains) {
    for (const view::MeshDraw& mesh : list.meshes) {
        if (auto found = obstacle_of(*mesh.mesh); !found.empty()) {
            return found;
        }
    }
    for (const SeenTerrain& terrain : terrains) {
        if (auto found = obstacle_in_view(list, terrain); !found.empty()) {
            return found;
        }
    }
    return terrains.size() > 1 ? "more than one terrain" : "";
}

} // namespace

std::string obstacle_of(const view::DrawList& list) {
    return obstacle_among(list, seen_terrains(list));
}

std::string obstacle_beside_triangles(const view::DrawList& list) {
    const std::vector<SeenTerrain> terrains = seen_terrains(list);
    const bool has_pole =
        std::any_of(terrains.begin(), terrains.end(), [](const SeenTerrain& terrain) {
            return terrain.has_pole &&
                   terrain.node->material.technique.id() != scene::TechniqueId::exact;
        });
    auto found = obstacle_among(list, terrains);
    return found.empty() && has_pole ? "a globe with a pole in view" : std::move(found);
}

Result<void> check_support(const view::DrawList& list) {
    const std::string found = obstacle_of(list);
    return found.empty()
               ? Result<void>()
               : Error{fmt::format("rays on the CPU do not draw {} (exact or an error bound over "
                                   "one terrain was expected); --context osmesa does",
                                   found)};
}

} // namespace reljef::cast
