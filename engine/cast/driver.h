#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/cast/lit_levels.h"
#include "engine/cast/picture_rays.h"
#include "engine/cast/ray_tile.h"
#include "engine/cast/simd_target.h"
#include "engine/core/color.h"
#include "engine/core/hit.h"
#include "engine/core/result.h"
#include "engine/view/frame_stats.h"
#include "engine/view/select.h"
#include "engine/view/terrain_maps.h"

namespace reljef::cast {

struct DriverOptions {
    glm::ivec2 size{1024, 768}; ///< of the picture, pixels
    unsigned threads = 0;       ///< 0: one per hardware thread; no influence on the result
    int samples = 1;            ///< per pixel: 1, or automatic_samples
    std::optional<SimdTarget> target = {}; ///< absent: the fastest of the machine
};

/// The driver's choice: 1.
inline constexpr int automatic_samples = 0;

/// Whether rays draw terrains with a technique: `exact`, or an error bound, which they keep;
/// without options.
bool draws_technique(const scene::Technique& technique);

/// What rays on the CPU cannot draw of a terrain with a technique; empty if they draw it.
std::string obstacle_of(const scene::TerrainNode& terrain, const scene::Technique& technique);

/// The same of a list, which has at most one terrain and no meshes.
std::string obstacle_of(const view::DrawList& list);
/// Fails if there is an obstacle.
Result<void> check_support(const view::DrawList& list);

/// Draws selected frames by rays on the CPU (cast_hits.h); light, air and sky are those of
/// render::Driver. Keeps what it makes of a terrain as long as the scene has its surface.
class Driver {
public:
    /// Fails on a size that is out of range, and with several samples per pixel.
    static Result<Driver> create(const DriverOptions& options = {});

    /// Draws a frame of size(), and has finished when it returns. Fails as check_support().
    Result<view::FrameStats> draw(const view::FrameView& frame);
    Result<view::DrawnHits> draw_hits(const view::FrameView& frame);

    /// The last frame.
    [[nodiscard]] const Image& read_color() const { return picture_; }

    /// Takes the light of a terrain that was computed before.
    Result<void> add_light(const view::PreparedLight& prepared);

    Result<void> resize(glm::ivec2 size);
    [[nodiscard]] glm::ivec2 size() const { return {picture_.cols(), picture_.rows()}; }

    /// Of the maps that light a terrain, texels.
    [[nodiscard]] static int max_texture_side() { return 1 << 14; }

private:
    struct Light {
        std::optional<scene::TerrainLight> light;
        std::shared_ptr<const LitLevels> levels;
    };
    struct Surface {
        std::weak_ptr<const scene::TerrainSurface> owner;
        std::shared_ptr<const RayTile> tile;
        Light light; // of the last frame
    };
    struct PlacedTerrain;

    explicit Driver(const DriverOptions& options);
    Surface& surface_of(const std::shared_ptr<const scene::TerrainSurface>& surface);
    const RayTile& tile_of(const scene::TerrainNode& terrain, view::FrameStats& stats);
    const LitLevels& levels_of(const scene::TerrainNode& terrain,
                               const std::optional<scene::TerrainLight>& light,
                               view::FrameStats& stats);
    void paint(const view::DrawList& list, const std::optional<PlacedTerrain>& terrain,
               view::FrameStats& stats);

    DriverOptions options_;
    Image picture_;
    std::map<const scene::TerrainSurface*, Surface> surfaces_;
};

} // namespace reljef::cast
