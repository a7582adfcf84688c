#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/gl/buffer.h"
#include "engine/gl/texture.h"
#include "engine/render/residency/coarse_tiles.h"
#include "engine/render/residency/ground_residency.h"
#include "engine/render/residency/mesh_residency.h"
#include "engine/render/residency/relief_maps.h"
#include "engine/render/residency/resident_mesh.h"
#include "engine/render/residency/streamed_tiles.h"
#include "engine/render/residency/terrain_maps.h"
#include "engine/view/draw_list.h"
#include "engine/view/grid_mesh.h"

namespace reljef::render {

/// A terrain's lit_map, or, where rays cast the shadows, its light_parts; and how sample
/// coordinates become texture coordinates: sample · xy + zw.
struct ResidentMaps {
    gl::Texture2D lit;
    std::optional<gl::Texture2D> sun; ///< the sun's part; lit is then the sky's
    glm::vec4 lit_from_sample{0.0F};
};

/// The heights that pixels look for along their rays, where they lie, and what some techniques need
/// besides: exact a pyramid of the greatest, cone the cones over each cell.
struct ResidentRelief {
    ReliefSpace space;
    gl::Texture2D heights;
    std::optional<gl::Texture2D> greatest;
    std::optional<gl::Texture2D> cones;
};

/// What of the scene is in the driver's memory. Only what is drawn gets there, and stays while the
/// scene holds its surface. Needs a current context; destroy while it is current.
class Residency {
public:
    /// Puts what the list draws into the driver's memory and counts it in `stats`; fails when the
    /// driver has no memory left.
    Result<void> prepare(const view::DrawList& list, bool with_maps, view::FrameStats& stats);

    /// Takes the light of a terrain that the next frame shows. Fails when the driver has no memory
    /// left.
    Result<void> add_light(const PreparedLight& prepared);

    /// Precondition: prepared.
    [[nodiscard]] std::span<const ResidentMesh> tile(const view::TileDraw& draw) const;
    [[nodiscard]] const ResidentMaps& maps(const scene::TerrainNode& terrain) const;
    [[nodiscard]] const ResidentRelief& relief(const view::ReliefDraw& draw) const;
    [[nodiscard]] const StreamedTiles& streamed() const { return streamed_tiles_; }
    [[nodiscard]] const MeshResidency& meshes() const { return meshes_; }
    [[nodiscard]] const GroundResidency& ground() const { return ground_; }
    /// What prewarp shows at each sample: warped_places.
    [[nodiscard]] const gl::Texture2D& warped(const scene::TerrainNode& terrain) const;

private:
    struct LitMaps {
        std::optional<scene::TerrainLight> light;
        bool in_parts = false;
        std::shared_ptr<const ResidentMaps> maps;
    };
    struct Surface {
        std::weak_ptr<const scene::TerrainSurface> owner;
        std::vector<std::optional<ResidentMesh>> tiles;
        std::vector<std::optional<ResidentMesh>> flat_tiles;
        std::vector<LitMaps> maps; // one for each light that the last frame had for it
        std::optional<ResidentRelief> relief;
    };
    void forget_unused();
    Surface& surface_of(const std::shared_ptr<const scene::TerrainSurface>& surface);
    std::vector<const view::TileDraw*> missing_tiles(const view::DrawList& list,
                                                     view::FrameStats& stats);
    Result<void> prepare_tiles(const view::DrawList& list, view::FrameStats& stats);
    Result<void> upload_tile(const view::TileDraw& draw, const view::GridMesh& grid,
                             view::FrameStats& stats);
    Result<void> prepare_all_maps(const view::DrawList& list, view::FrameStats& stats);
    Result<void> prepare_maps(const view::DrawList& list, const scene::TerrainNode& terrain,
                              const glm::dmat4& world_from_local, view::FrameStats& stats);
    Result<std::shared_ptr<const ResidentMaps>>
    maps_for(const scene::TerrainNode& terrain, const std::optional<scene::TerrainLight>& light,
             view::FrameStats& stats);
    Result<void> prepare_relief(const view::ReliefDraw& draw, view::FrameStats& stats);
    Result<void> prepare_warped(const view::DrawList& list, view::FrameStats& stats);
    Result<const gl::Buffer*> indices_for(int cols, int rows, view::FrameStats& stats);

    std::map<const scene::TerrainSurface*, Surface> surfaces_;
    CoarseTiles coarse_tiles_;
    StreamedTiles streamed_tiles_;
    std::map<const scene::TerrainNode*, std::shared_ptr<const ResidentMaps>> maps_; // last prepared
    std::map<const scene::TerrainNode*, gl::Texture2D> warped_; // of the last frame
    MeshResidency meshes_;
    GroundResidency ground_;
    std::map<std::pair<int, int>, gl::Buffer> grid_indices_; // by quads along a row, and a column
};

} // namespace reljef::render
