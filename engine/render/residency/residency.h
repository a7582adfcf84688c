#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/gl/buffer.h"
#include "engine/gl/texture.h"
#include "engine/render/residency/facade_residency.h"
#include "engine/render/residency/grain_residency.h"
#include "engine/render/residency/ground_residency.h"
#include "engine/render/residency/mesh_residency.h"
#include "engine/render/residency/relief_maps.h"
#include "engine/render/residency/relief_tiles.h"
#include "engine/render/residency/sky_residency.h"
#include "engine/render/residency/tile_maps.h"
#include "engine/render/triangles/terrain_meshes.h"
#include "engine/view/draw_list.h"
#include "engine/view/terrain_maps.h"

namespace reljef::render {

/// A terrain's view::lit_map(), or its view::light_parts() if rays cast the shadows. Texture
/// coordinate = sample · xy + zw.
struct ResidentMaps {
    gl::Texture2D lit;
    std::optional<gl::Texture2D> sun; ///< the sun's part; then lit is the sky's
    glm::vec4 lit_from_sample{0.0F};
};

struct ResidentRelief {
    ReliefSpace space;
    gl::Texture2D heights;
    std::optional<gl::Texture2D> max_mipmap; ///< for exact and beams
    std::optional<gl::Texture2D> cones;      ///< for cone, per cell
};

/// The scene's content in GPU memory. Drawn content is uploaded and stays as long as the scene has
/// its surface.
class Residency {
public:
    /// Uploads the list's content and counts it in `stats`. `casters`: meshes beside the picture
    /// whose shadows are in it. Fails without GL memory.
    Result<void> prepare(const view::DrawList& list, bool with_maps,
                         std::span<const view::MeshDraw> casters, view::FrameStats& stats);

    /// Tiles get new triangles in the next frame.
    void forget_cuts() { terrain_meshes_.forget_cuts(); }

    /// Adds precomputed light of a terrain in the next frame. Fails without GL memory.
    Result<void> add_light(const view::PreparedLight& prepared);

    /// Precondition: prepared.
    [[nodiscard]] const TerrainMeshes& terrain_meshes() const { return terrain_meshes_; }
    [[nodiscard]] const TileMaps& tile_maps() const { return tile_maps_; }
    [[nodiscard]] const ResidentMaps& maps(const scene::TerrainNode& terrain) const;
    [[nodiscard]] const ResidentRelief& relief(const view::TerrainDraw& draw) const;
    [[nodiscard]] const MeshResidency& meshes() const { return meshes_; }
    [[nodiscard]] const GroundResidency& ground() const { return ground_; }
    /// Precondition: a terrain of the prepared list has grain, and it was prepared with maps.
    [[nodiscard]] const GrainResidency& grain() const { return grain_; }
    /// Preconditions: a terrain of the prepared list shows façades, and it was prepared with maps.
    [[nodiscard]] const FacadeResidency& facades() const { return facades_; }
    /// Precondition: prepared with maps.
    [[nodiscard]] const SkyResidency& sky() const { return sky_; }
    [[nodiscard]] const ReliefTiles& relief_tiles() const { return relief_tiles_; }
    /// What is certain of the sun in each cell (scene::CertainSun as a float), for exact with hard
    /// shadows on a plane; else null.
    [[nodiscard]] const gl::Texture2D* certain_sun(const view::TerrainDraw& draw) const;
    /// warped_places() for prewarp.
    [[nodiscard]] const gl::Texture2D& warped(const scene::TerrainNode& terrain) const;

private:
    struct LitMaps {
        std::optional<scene::TerrainLight> light;
        bool in_parts = false;
        std::shared_ptr<const ResidentMaps> maps;
    };
    struct Surface {
        std::weak_ptr<const scene::TerrainSurface> owner;
        std::vector<LitMaps> maps; // one per light of the last frame
        std::optional<ResidentRelief> relief;
    };
    // Nodes of one surface may be turned, and have other light.
    struct CertainSun {
        std::weak_ptr<const scene::TerrainSurface> surface;
        scene::TerrainLight light;
        gl::Texture2D cells;
    };
    using CertainSuns = std::map<const scene::TerrainNode*, CertainSun>;
    void forget_unused();
    Surface& surface_of(const std::shared_ptr<const scene::TerrainSurface>& surface);
    Result<void> prepare_colors(const view::DrawList& list, view::FrameStats& stats);
    Result<void> prepare_all_maps(const view::DrawList& list, view::FrameStats& stats);
    Result<void> prepare_maps(const view::DrawList& list, const scene::TerrainNode& terrain,
                              const glm::dmat4& world_from_local, view::FrameStats& stats);
    Result<std::shared_ptr<const ResidentMaps>>
    maps_for(const scene::TerrainNode& terrain, const std::optional<scene::TerrainLight>& light,
             view::FrameStats& stats);
    Result<void> prepare_reliefs(const view::DrawList& list, bool with_maps,
                                 view::FrameStats& stats);
    Result<void> prepare_relief(const view::TerrainDraw& draw, view::FrameStats& stats);
    Result<void> prepare_certain_sun(const view::DrawList& list, const view::TerrainDraw& draw,
                                     CertainSuns& last, view::FrameStats& stats);
    Result<void> prepare_warped(const view::DrawList& list, view::FrameStats& stats);

    std::map<const scene::TerrainSurface*, Surface> surfaces_;
    TerrainMeshes terrain_meshes_;
    TileMaps tile_maps_;
    ReliefTiles relief_tiles_;
    std::map<const scene::TerrainNode*, std::shared_ptr<const ResidentMaps>> maps_;
    std::map<const scene::TerrainNode*, gl::Texture2D> warped_; // of the last frame
    CertainSuns certain_suns_;                                  // of the last picture
    MeshResidency meshes_;
    GroundResidency ground_;
    GrainResidency grain_;
    FacadeResidency facades_;
    SkyResidency sky_;
};

} // namespace reljef::render
