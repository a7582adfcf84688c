#pragma once

#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "engine/core/geometry.h"
#include "engine/core/result.h"
#include "engine/scene/graph/scene.h"
#include "engine/scene/graph/terrain_light.h"
#include "engine/scene/streamed_tile.h"
#include "engine/terrain/mesh/bisection_mesh.h"
#include "engine/view/frame_stats.h"
#include "engine/view/ground_view.h"

namespace reljef::view {

/// How coarse a terrain's tiles may be: as coarse as the view allows, or patches by their level
/// (terrain/patch_mesh.h).
using Coarseness = std::variant<terrain::ErrorView, Grid<std::uint8_t>>;

/// One terrain tile to draw.
struct TileDraw {
    const scene::TerrainNode* terrain = nullptr;
    double distance = 0.0;                  ///< from the eye to its bounds' nearest point, metres
    int transform = 0;                      ///< index into DrawList::transforms
    int tile = 0;                           ///< index into the surface's tiles
    DetailLevel detail = DetailLevel::none; ///< of what lies over the terrain
    bool flat = false;                      ///< the reference surface instead of the heightfield
    bool coarse = false; ///< as DrawList::coarse_terrains says, instead of every sample
};

/// One terrain whose tiles need not have every sample as a vertex.
struct CoarseTerrain {
    const scene::TerrainNode* terrain = nullptr;
    Coarseness coarseness;
};

/// One terrain whose surface each pixel looks for along its ray.
struct ReliefDraw {
    const scene::TerrainNode* terrain = nullptr;
    glm::dmat4 world_from_local{1.0};
    double distance = 0.0; ///< from the eye to its bounds' nearest point, metres
};

/// One tile of a terrain that is read part by part.
struct StreamedDraw {
    const scene::TerrainNode* terrain = nullptr;
    glm::dmat4 world_from_local{1.0};
    std::shared_ptr<const scene::StreamedTile> tile;
    bool flat = false;                      ///< on the reference surface instead of its heights
    double distance = 0.0;                  ///< from the eye to its bounds' nearest point, metres
    DetailLevel detail = DetailLevel::none; ///< of what lies over the terrain
    double error = 0.0; ///< that its vertices are seen off by, an estimate, pixels
    /// Behind nearer ground: drawn by itself, as the tiles around it need not meet it.
    bool is_hidden = false;
};

struct MeshDraw {
    const scene::MeshNode* mesh = nullptr;
    glm::dmat4 world_from_local{1.0};
    bool from_behind = false; ///< its inner side
};

/// What to draw this frame: pure data, decided on the CPU. Valid as long as the scene is unchanged.
struct DrawList {
    scene::Camera camera;
    glm::ivec2 size{0};              ///< of the picture, pixels
    std::optional<scene::Light> sun; ///< the first light in the tree
    std::optional<scene::Sky> sky;
    std::vector<glm::dmat4> transforms;       ///< world from local, of the nodes with tiles
    std::vector<TileDraw> tiles;              ///< front to back
    std::vector<StreamedDraw> streamed_tiles; ///< front to back
    std::vector<CoarseTerrain> coarse_terrains;
    std::vector<ReliefDraw> reliefs; ///< front to back
    std::vector<MeshDraw> meshes;
    FrameStats stats; ///< nodes and what was skipped, so far

    [[nodiscard]] const glm::dmat4& world_from_local(const TileDraw& draw) const {
        return transforms[static_cast<std::size_t>(draw.transform)];
    }
};

/// Whether each terrain and mesh can be drawn as it is asked to be; fails as
/// scene::check_technique.
Result<void> check_techniques(const DrawList& list);

/// The list's sun over a terrain that is placed so; nothing without a sun.
std::optional<scene::TerrainLight> light_on(const DrawList& list,
                                            const glm::dmat4& world_from_local);

} // namespace reljef::view
