#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/cast/block_rays.h"
#include "engine/cast/frame/mesh_frame.h"
#include "engine/cast/packet/block_kernel.h"
#include "engine/cast/picture_rays.h"
#include "engine/cast/picture_samples.h"
#include "engine/cast/simd_target.h"
#include "engine/core/color.h"
#include "engine/core/grid.h"
#include "engine/view/draw_list.h"
#include "engine/view/frame_stats.h"

namespace reljef::cast {

struct PainterOptions {
    std::optional<SimdTarget> target = {}; ///< absent: the fastest of the machine
    RaySkips skips = {};
    int samples = 1;                      ///< of a pixel
    const MeshFrame* meshes = nullptr;    ///< null: none; outlives the painter
    const DetailPaint* detail = nullptr;  ///< null: none; outlives the painter
    const GrainPaint* grain = nullptr;    ///< null: none; outlives the painter
    const FacadePaint* facades = nullptr; ///< null: none; outlives the painter
    const SkyPaint* sky = nullptr;        ///< null: no picture; outlives the painter
    ContourPaint contours = {};
    glm::mat3 world_from_normal{1.0F}; ///< BlockPaint::world_from_normal
    /// Hit::depth of the picture's pixels; null: not needed. Outlives the painter.
    Grid<float>* depths = nullptr;
};

/// Draws the blocks of a picture. May be called from several threads for different blocks.
class Painter {
public:
    /// `placed` and `first` outlive this object.
    Painter(const view::DrawList& list, const PlacedTiles& placed, const PainterOptions& options,
            FirstSamples& first);

    /// Into the picture of the first samples, and the depths.
    void paint(const PixelBlock& block, std::size_t index);
    /// Returns the taps of the block's beams.
    [[nodiscard]] std::size_t count(const PixelBlock& block, std::size_t index,
                                    Grid<view::PixelWork>& pixels) const;
    /// Chooses pixels that need several samples. Precondition: all blocks are painted.
    void choose_sampled(const PixelBlock& block, std::size_t index);
    /// These show the mean of their samples then. Precondition: chosen in all blocks.
    void sample(const PixelBlock& block, std::size_t index);

    [[nodiscard]] bool has_samples() const { return samples_.samples > 1; }

private:
    [[nodiscard]] BlockPaint paint_of(const PixelBlock& block, std::size_t index) const;
    [[nodiscard]] bool shows_meshes(std::size_t block) const {
        return meshes_ != nullptr && meshes_->may_show(block);
    }

    const PlacedTiles& placed_;
    RaySkips skips_;
    const MeshFrame* meshes_;
    BlockKernel kernel_;
    BlockPaint shared_;
    PictureRays rays_; // in world metres from the eye
    std::vector<PointLightPaint> point_lights_;
    std::vector<std::vector<WallTriangle>> walls_; // of the blocks; empty: none
    glm::vec2 corner_;                             // see view::dither_origin()
    PixelBlock picture_;                           // a part may reach beyond its picture
    FirstSamples& first_;
    Grid<float>* depths_;                             // null: not needed
    double anchor_;                                   // of the rays
    std::vector<std::vector<BlockJob>> jobs_;         // of the blocks, for their samples
    std::vector<std::vector<std::uint16_t>> sampled_; // of the blocks
    SampledPixels samples_;
};

} // namespace reljef::cast
