#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/cast/frame/seen_terrain.h"
#include "engine/cast/packet/block_kernel.h"
#include "engine/material/relief_material.h"
#include "engine/view/draw_list.h"

namespace reljef::cast {

/// The maps of a detail texture with their mip levels, to read by packets of rays.
class DetailMaps {
public:
    explicit DetailMaps(const material::ReliefMaterial& set);

    /// Sets what the maps and the material give. Valid as long as these.
    void paint(DetailPaint& paint) const;

private:
    std::vector<std::uint32_t> color_texels_;
    std::vector<std::uint32_t> normal_texels_;
    std::vector<float> heights_;
    DetailPaint paint_; // its pointers are set when it is used
};

/// Whether rays show a detail texture on a terrain with this technique.
bool draws_detail(const scene::Technique& technique);

/// Whether a drawn tile of the terrain is near enough to show its detail texture.
bool shows_detail(const view::DrawList& list, const scene::TerrainNode& terrain);

/// The detail texture of near ground, for rays. Its maps are made once.
class GroundDetail {
public:
    /// Null: none is shown. Valid as long as this object, until the next call. Precondition:
    /// draws_detail() its technique.
    const DetailPaint* prepare(const view::DrawList& list, const SeenTerrain& seen);

private:
    std::weak_ptr<const material::ReliefMaterial> owner_;
    std::shared_ptr<const DetailMaps> maps_;
    DetailPaint paint_;
};

} // namespace reljef::cast
