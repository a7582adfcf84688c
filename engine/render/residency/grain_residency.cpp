#include "engine/render/residency/grain_residency.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/core/color.h"
#include "engine/core/grid.h"
#include "engine/material/grain_map.h"
#include "engine/render/shaders/bindings.h"

namespace reljef::render {
namespace {

bool has_grain(const view::DrawList& list) {
    return std::any_of(
        list.terrains.begin(), list.terrains.end(),
        [](const view::TerrainDraw& draw) { return scene::shown_grain(*draw.terrain) > 0.0F; });
}

Grid<Rgba8> level_of(const material::GrainMap& map, material::GrainMap::Layer layer, int level) {
    const int side = material::GrainMap::side >> level;
    Grid<Rgba8> texels(side, side);
    const auto from = map.level(layer, level);
    std::transform(from.begin(), from.end(), texels.samples().begin(), [](std::uint32_t texel) {
        const glm::vec3 share = 0.5F * material::grain_of(texel) + 0.5F;
        const auto byte = [](float channel) {
            return static_cast<std::uint8_t>(std::lround(255.0F * channel));
        };
        return Rgba8{byte(share.x), byte(share.y), byte(share.z), 255};
    });
    return texels;
}

// The layers of `map`, one after the other.
Result<gl::TextureArray> uploaded(const material::GrainMap& map, view::FrameStats& stats) {
    auto texture = gl::TextureArray::create({.size = glm::ivec2(material::GrainMap::side),
                                             .format = gl::Format::rgba8,
                                             .levels = material::GrainMap::level_count,
                                             .filter = gl::Filter::trilinear,
                                             .wrap = gl::Wrap::repeat},
                                            material::GrainMap::layer_count);
    if (!texture) {
        return texture;
    }
    for (int layer = 0; layer < material::GrainMap::layer_count; ++layer) {
        for (int level = 0; level < material::GrainMap::level_count; ++level) {
            texture->upload(layer, level,
                            level_of(map, static_cast<material::GrainMap::Layer>(layer), level));
        }
        stats.upload_bytes += texture->bytes_per_layer();
    }
    ++stats.uploads;
    return texture;
}

} // namespace

Result<void> GrainResidency::prepare(const view::DrawList& list, view::FrameStats& stats) {
    if (layers_ || !has_grain(list)) {
        return {};
    }
    auto layers = uploaded(material::GrainMap(), stats);
    if (!layers) {
        return layers.error();
    }
    layers_ = std::move(*layers);
    return {};
}

void GrainResidency::bind() const {
    layers_->bind(bindings::grain_layers_unit);
}

} // namespace reljef::render
