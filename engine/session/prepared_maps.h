#pragma once

#include <map>
#include <memory>
#include <optional>
#include <stop_token>

#include "engine/core/result.h"
#include "engine/material/cone_map.h"
#include "engine/material/relief_material.h"
#include "engine/render/residency/terrain_maps.h"
#include "engine/scene/technique/technique.h"
#include "engine/session/log.h"
#include "engine/session/scene_setup.h"
#include "engine/terrain/mesh/bisection.h"

namespace reljef::session {

/// The maps that a technique lacks in a scene and that take long to make. Shares what they are made
/// of, so that making them needs no scene.
struct MissingMaps {
    using Set = std::shared_ptr<const material::ReliefMaterial>;

    std::shared_ptr<const scene::TerrainSurface> surface; ///< whose maps are missing; null: none
    bool bisection = false;                               ///< for polygons with an error bound
    bool cones = false;                                   ///< for the technique cone
    std::map<Set, std::vector<material::KnownCones>> set_cones; ///< of detail textures: which sides
    std::optional<render::LightRequest> light; ///< not looked for by missing_maps()

    [[nodiscard]] bool empty() const { return surface == nullptr && set_cones.empty() && !light; }
};

/// What the scene lacks to be drawn with a technique; absent: with the techniques of its materials.
/// A renderer would make it itself, in the middle of a frame.
MissingMaps missing_maps(const TerrainScene& scene,
                         const std::optional<scene::Technique>& technique = std::nullopt);

/// The terrain's light as a technique needs it. Nothing in the gallery, whose models are lit as
/// they are drawn. `largest_side`: of its maps, texels; SceneRenderer::max_texture_side().
std::optional<render::LightRequest> light_request(const TerrainScene& scene,
                                                  const scene::Light& light,
                                                  const scene::Technique& technique,
                                                  int largest_side);

/// Maps that were made, or read from the cache.
struct PreparedMaps {
    std::shared_ptr<const scene::TerrainSurface> surface; ///< whose maps these are
    std::shared_ptr<const terrain::Bisection> bisection;
    std::shared_ptr<const material::ConeMaps> cones;
    std::map<MissingMaps::Set, MissingMaps::Set> sets;  ///< the same detail textures with cones
    std::shared_ptr<const render::PreparedLight> light; ///< for SceneRenderer::add_light()
};

/// Makes them, or reads them from the cache; on any thread. `threads` 0: as many as the machine
/// has. Fails when it was stopped.
Result<PreparedMaps> prepare_maps(const MissingMaps& missing, int threads, Log& log,
                                  const std::stop_token& stop);

/// Puts maps into the scene they were made for; the light is the renderer's.
void apply_maps(TerrainScene& scene, const PreparedMaps& maps);

/// Puts the cones over the sides of a detail texture that the technique sees, with its border, into
/// the set; nothing where the technique needs none. Fails when it was stopped.
Result<void> add_cones(material::ReliefMaterial& set, const scene::Technique& technique,
                       int threads, Log& log, const std::stop_token& stop);

} // namespace reljef::session
