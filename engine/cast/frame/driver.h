#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/cast/block_rays.h"
#include "engine/cast/frame/ground_detail.h"
#include "engine/cast/frame/ground_facades.h"
#include "engine/cast/frame/ground_grain.h"
#include "engine/cast/frame/ground_points.h"
#include "engine/cast/frame/mesh_frame.h"
#include "engine/cast/frame/painter.h"
#include "engine/cast/frame/ray_support.h"
#include "engine/cast/frame/seen_terrain.h"
#include "engine/cast/frame/sky_texels.h"
#include "engine/cast/frame/tile_contents.h"
#include "engine/cast/lit_levels.h"
#include "engine/cast/mesh/mesh_surface.h"
#include "engine/cast/mesh/mesh_trees.h"
#include "engine/cast/picture_rays.h"
#include "engine/cast/picture_samples.h"
#include "engine/cast/ray_tile.h"
#include "engine/cast/simd_target.h"
#include "engine/core/color.h"
#include "engine/core/hit.h"
#include "engine/core/result.h"
#include "engine/view/choice/ray_rounding.h"
#include "engine/view/frame_stats.h"
#include "engine/view/sample_count.h"
#include "engine/view/select.h"
#include "engine/view/terrain_maps.h"

namespace reljef::cast {

struct DriverOptions {
    glm::ivec2 size{1024, 768}; ///< of the picture, pixels
    unsigned threads = 0;       ///< 0: one per hardware thread; no influence on the result
    /// Per pixel, see view::check_samples(). Each sample has its own ray where surfaces end or bend
    /// sharply; all other pixels have one. Hits are those of the pixels' middles.
    int samples = 1;
    bool samples_all = false; ///< each sample of all pixels has its own ray, to measure the others
    std::optional<SimdTarget> target = {}; ///< absent: the fastest of the machine
    RaySkips skips = {};                   ///< no influence on the picture
    /// Keeps what was made of terrains for the next frames. No influence on the picture.
    bool keeps_content = true;
};

/// What a frame draws; of reliefs over streams, tiles.
struct StreamedList {
    view::DrawList list;
    std::vector<TileContents::SharedTile> above; ///< those above the drawn ones in their tree
};

/// Draws selected frames by rays on the CPU (cast_hits.h, mesh_frame.h); light, air and sky are
/// those of render::Driver. Keeps what it makes of a terrain as long as the scene has its surface.
class Driver {
public:
    /// Fails on a size that is out of range, and as view::check_samples().
    static Result<Driver> create(const DriverOptions& options = {});

    /// Draws a frame of size(), and has finished when it returns. `keeps_depths`: for depths().
    /// Fails as check_support() and MeshTrees::place().
    Result<view::FrameStats> draw(const view::FrameView& frame, bool keeps_depths = false);
    Result<view::DrawnHits> draw_hits(const view::FrameView& frame);
    /// What each pixel of draw() costs with one sample: exactly what its rays read of the ground,
    /// and their steps. Without the few steps of the beams of whole blocks (RaySkips::free_space).
    Result<view::PictureWork> count_work(const view::FrameView& frame);

    /// The last frame.
    [[nodiscard]] const Image& read_color() const { return first_.picture; }
    /// The same, to draw over it.
    [[nodiscard]] Image& picture() { return first_.picture; }

    /// Hit::depth of the hits of the last frame; infinite on walls below terrains. Precondition:
    /// the last draw() kept them.
    [[nodiscard]] const Grid<float>& depths() const { return depths_; }

    /// Takes the light of a terrain that was computed before.
    Result<void> add_light(const view::PreparedLight& prepared);

    /// Releases what was made of terrains; the next frame makes what it needs again.
    void forget_content();

    Result<void> resize(glm::ivec2 size);
    [[nodiscard]] glm::ivec2 size() const { return {first_.picture.cols(), first_.picture.rows()}; }
    /// See DriverOptions::samples. Precondition: view::check_samples().
    void set_samples(int samples) { options_.samples = samples; }

    /// Of the maps that light a terrain, texels.
    [[nodiscard]] static int max_texture_side() { return 1 << 14; }

private:
    struct Light {
        std::optional<scene::TerrainLight> light;
        std::shared_ptr<const LitLevels> levels;
        std::shared_ptr<const LitLevels> sun;  // without shadows; null: the levels have its light
        std::vector<std::int32_t> certain_sun; // BlockJob::certain_sun; empty: not made yet
    };
    struct Surface {
        std::weak_ptr<const scene::TerrainSurface> owner;
        std::vector<std::shared_ptr<const RayTile>> tiles; // of surface_pieces()
        Light light;                                       // of the last frame
        std::shared_ptr<const LitGround> ground; // for point lights and detail; null: not made yet
        std::optional<scene::TerrainLight> ground_light; // absent: without its share of the sun
    };

    explicit Driver(const DriverOptions& options);
    Surface& surface_of(const std::shared_ptr<const scene::TerrainSurface>& surface);
    void place_surface(const SeenTerrain& seen, const PictureRays& rays, PlacedTiles& placed,
                       view::FrameStats& stats);
    const Light& light_of(const scene::TerrainNode& terrain,
                          const std::optional<scene::TerrainLight>& light, view::FrameStats& stats);
    view::PictureRounding::Found rounding_of(const view::DrawList& list, const SeenTerrain& seen);
    void add_certain_sun(const view::DrawList& list, const SeenTerrain& seen, PlacedTile& tile);
    void paint_surface(const view::DrawList& list, const SeenTerrain& seen, PlacedTiles& placed,
                       view::FrameStats& stats);
    const LitGround& ground_of(const scene::TerrainNode& terrain,
                               const std::optional<scene::TerrainLight>& light,
                               view::FrameStats& stats);
    PlacedTiles placed_tiles(const StreamedList& frame, bool paints, view::FrameStats& stats);
    // With detail, grain, façades and contours; adds to the paints of `placed`.
    PainterOptions painter_options(const view::DrawList& list, PlacedTiles& placed);
    // Null without meshes.
    Result<std::unique_ptr<const MeshFrame>> mesh_frame(const StreamedList& frame,
                                                        const PlacedTiles& placed);
    void paint(const view::DrawList& list, const PlacedTiles& placed,
               const PainterOptions& options);
    view::PictureWork count(const view::DrawList& list, const PlacedTiles& placed);

    DriverOptions options_;
    FirstSamples first_; // its picture becomes that of all samples
    Grid<float> depths_; // empty unless they are kept
    std::map<const scene::TerrainSurface*, Surface> surfaces_;
    view::PictureRounding rounding_;
    TileContents streamed_;
    GroundDetail detail_;
    GroundGrain grain_;
    GroundFacades facades_;
    SkyTexels sky_;
    MeshTrees mesh_trees_;
    MeshPictures mesh_pictures_;
};

} // namespace reljef::cast
