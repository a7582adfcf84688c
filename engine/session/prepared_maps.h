#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "engine/core/result.h"
#include "engine/material/cone_map.h"
#include "engine/material/relief_material.h"
#include "engine/scene/technique/technique.h"
#include "engine/session/log.h"
#include "engine/session/objects/object_levels.h"
#include "engine/session/scene_setup.h"
#include "engine/terrain/mesh/bisection.h"
#include "engine/view/terrain_maps.h"

namespace reljef::session {

/// The slow maps that a technique lacks. Shares their inputs, so that making them needs no scene.
struct MissingMaps {
    using Set = std::shared_ptr<const material::ReliefMaterial>;

    std::shared_ptr<const scene::TerrainSurface> surface; ///< null: it lacks no maps
    bool bisection = false;                               ///< for polygons with an error bound
    bool cones = false;                                   ///< for the technique cone
    std::map<Set, std::vector<material::KnownCones>> set_cones; ///< sides of detail textures
    std::optional<view::LightRequest> light;                    ///< missing_maps() leaves it empty

    [[nodiscard]] bool empty() const { return surface == nullptr && set_cones.empty() && !light; }
};

/// The maps that the scene lacks for a technique; absent: for those of its materials. Otherwise the
/// renderer makes them during a frame.
MissingMaps missing_maps(const TerrainScene& scene,
                         const std::optional<scene::Technique>& technique = std::nullopt);

/// The same for one technique for each of its materials.
MissingMaps missing_maps(const TerrainScene& scene, std::span<const scene::Technique> techniques);

/// Those of a terrain outside of a scene.
MissingMaps missing_maps(const scene::TerrainNode& terrain, const scene::Technique& technique,
                         RayUse rays);

/// The terrain's light for a technique; empty in the gallery, whose models are lit by shaders.
/// `largest_side`: of its maps, texels; SceneRenderer::max_texture_side().
std::optional<view::LightRequest> light_request(const TerrainScene& scene,
                                                const scene::Light& light,
                                                const scene::Technique& technique,
                                                int largest_side);

struct PreparedMaps {
    std::shared_ptr<const scene::TerrainSurface> surface; ///< of the maps
    std::shared_ptr<const terrain::Bisection> bisection;
    std::shared_ptr<const material::ConeMaps> cones;
    std::map<MissingMaps::Set, MissingMaps::Set> sets; ///< detail textures, and the same with cones
    std::shared_ptr<const view::PreparedLight> light;  ///< for SceneRenderer::add_light()
};

/// Makes the maps or reads them from the cache, on any thread. `threads` 0: as many as the machine
/// has. Fails after a stop request.
Result<PreparedMaps> prepare_maps(const MissingMaps& missing, int threads, Log& log,
                                  const std::stop_token& stop);

/// Puts the maps, except the light, into the scene they were made for.
void apply_maps(TerrainScene& scene, const PreparedMaps& maps);

/// The meshes that need levels of detail and lack them; none if the ground keeps no error bound.
std::vector<ObjectMesh> missing_levels(const TerrainScene& scene);

/// Makes missing_levels(). Fails after a stop request.
Result<void> add_levels(const TerrainScene& scene, int threads, Log& log,
                        const std::stop_token& stop);

/// Adds the missing cones of a detail texture for `cone`; other techniques need none. Fails after a
/// stop request.
Result<void> add_cones(material::ReliefMaterial& set, const scene::Technique& technique,
                       int threads, Log& log, const std::stop_token& stop);

} // namespace reljef::session
