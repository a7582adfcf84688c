#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <irrlicht/irrlicht.h>

#include "bench/baselines/program/program.h"

namespace reljef::bench::baseline {

inline constexpr int place_steps = 4096;    // of a texture coordinate, in 3 channels of 4 bits
inline constexpr int channel_steps = 16;    // of a channel
inline constexpr int channel_step = 17;     // 255 / 15
inline constexpr int max_channel_error = 4; // of light that is not quite 1, and of rounding

/// A flat square at the middle height with Irrlicht's parallax material, whose normal map has the
/// heights in its alpha. The light comes from straight above and does not change the colours.
class ReliefPlane {
public:
    ReliefPlane(irr::scene::ISceneManager& scene, const Arguments& arguments)
        : scene_(scene), driver_(*scene.getVideoDriver()), arguments_(arguments) {
        const auto [low, high] =
            std::minmax_element(arguments.heights.begin(), arguments.heights.end());
        low_ = *low;
        range_ = std::max(*high - *low, 1e-3F);
    }

    /// Whether the driver has the shaders of the material.
    [[nodiscard]] bool is_supported() const {
        return driver_.queryFeature(irr::video::EVDF_ARB_VERTEX_PROGRAM_1) &&
               driver_.queryFeature(irr::video::EVDF_ARB_FRAGMENT_PROGRAM_1);
    }

    void build(irr::video::ITexture* colors) {
        colors_ = colors;
        place_textures_ = {make_place_texture(0), make_place_texture(1)};
        auto* const mesh = make_mesh();
        node_ = scene_.addMeshSceneNode(mesh);
        mesh->drop();
        irr::video::SMaterial& material = node_->getMaterial(0);
        material.MaterialType = irr::video::EMT_PARALLAX_MAP_SOLID;
        material.MaterialTypeParam = 0.5F * range_ / east();
        material.Lighting = false;
        material.BackfaceCulling = false;
        material.setTexture(1, make_height_texture());
        for (irr::u32 layer = 0; layer < 2; ++layer) {
            material.TextureLayer[layer].TextureWrapU = irr::video::ETC_CLAMP_TO_EDGE;
            material.TextureLayer[layer].TextureWrapV = irr::video::ETC_CLAMP_TO_EDGE;
        }
        scene_.addLightSceneNode(nullptr, {0.0F, 1e3F * east(), 0.0F}, {1.0F, 1.0F, 1.0F, 1.0F},
                                 1e6F * east());
        show_colors();
    }

    void show_colors() { show(colors_, true); }
    /// Each pixel then shows its texture coordinate along an axis, see place_of_color().
    void show_places(int axis) { show(place_textures_[static_cast<std::size_t>(axis)], false); }

    /// The sample along an axis; -1: no terrain.
    [[nodiscard]] float sample_of(const std::array<std::uint8_t, 3>& color) const {
        int step = 0;
        for (const int channel : color) {
            const int part = (channel + channel_step / 2) / channel_step;
            if (std::abs(channel - part * channel_step) > max_channel_error) {
                return -1.0F;
            }
            step = step * channel_steps + part;
        }
        const float place = (static_cast<float>(step) + 0.5F) / place_steps;
        return std::max(place * texels() - 0.5F, 0.0F);
    }

    /// A color that is no place.
    [[nodiscard]] static irr::video::SColor background() {
        return {255, channel_step / 2, channel_step / 2, channel_step / 2};
    }

private:
    static constexpr irr::u32 quads = 128; // a side, as the eye's direction is that of vertices

    // Of the textures, which have no last row and column.
    [[nodiscard]] float texels() const { return static_cast<float>(arguments_.side - 1); }
    [[nodiscard]] float east() const { return texels() * arguments_.east; }
    [[nodiscard]] float north() const { return texels() * arguments_.north; }

    void show(irr::video::ITexture* texture, bool filtered) {
        irr::video::SMaterial& material = node_->getMaterial(0);
        material.setTexture(0, texture);
        material.TextureLayer[0].BilinearFilter = filtered;
        material.TextureLayer[0].TrilinearFilter = filtered;
    }

    irr::scene::SMesh* make_mesh() {
        auto* const buffer = new irr::scene::SMeshBufferTangents;
        for (irr::u32 row = 0; row <= quads; ++row) {
            for (irr::u32 col = 0; col <= quads; ++col) {
                buffer->Vertices.push_back(
                    vertex(static_cast<float>(col) / quads, static_cast<float>(row) / quads));
            }
        }
        for (irr::u32 row = 0; row < quads; ++row) {
            for (irr::u32 col = 0; col < quads; ++col) {
                const irr::u32 first = row * (quads + 1) + col;
                const irr::u32 below = first + quads + 1;
                for (const irr::u32 index :
                     {first, first + 1, below, first + 1, below + 1, below}) {
                    buffer->Indices.push_back(static_cast<irr::u16>(index));
                }
            }
        }
        buffer->recalculateBoundingBox();
        buffer->setHardwareMappingHint(irr::scene::EHM_STATIC);
        auto* const mesh = new irr::scene::SMesh;
        mesh->addMeshBuffer(buffer);
        mesh->recalculateBoundingBox();
        buffer->drop();
        return mesh;
    }

    // Samples lie in the middle of texels. One scale serves both axes of the texture: what is
    // longer there has a shorter binormal.
    [[nodiscard]] irr::video::S3DVertexTangents vertex(float u, float v) const {
        const float half_texel = 0.5F / texels();
        return {
            irr::core::vector3df((u - 0.5F) * east(), low_ + 0.5F * range_, (0.5F - v) * north()),
            irr::core::vector3df(0.0F, 1.0F, 0.0F),
            {255, 255, 255, 255},
            {u + half_texel, v + half_texel},
            irr::core::vector3df(1.0F, 0.0F, 0.0F),
            irr::core::vector3df(0.0F, 0.0F, east() / north())};
    }

    irr::video::ITexture* add_texture(const char* name, irr::video::IImage* image, bool levels) {
        driver_.setTextureCreationFlag(irr::video::ETCF_CREATE_MIP_MAPS, levels);
        driver_.setTextureCreationFlag(irr::video::ETCF_ALWAYS_32_BIT, true);
        irr::video::ITexture* const texture = driver_.addTexture(name, image);
        driver_.setTextureCreationFlag(irr::video::ETCF_CREATE_MIP_MAPS, true);
        image->drop();
        return texture;
    }

    // Normals straight up, heights in the alpha.
    irr::video::ITexture* make_height_texture() {
        const irr::u32 side = arguments_.side - 1;
        irr::video::IImage* const image =
            driver_.createImage(irr::video::ECF_A8R8G8B8, {side, side});
        for (irr::u32 row = 0; row < side; ++row) {
            for (irr::u32 col = 0; col < side; ++col) {
                const float height =
                    arguments_.heights[std::size_t{col} * arguments_.side + side - row];
                const auto step =
                    static_cast<irr::u32>(std::lround(255.0F * (height - low_) / range_));
                image->setPixel(col, row, {step, 128, 128, 255});
            }
        }
        return add_texture("heights", image, false);
    }

    irr::video::ITexture* make_place_texture(irr::u32 axis) {
        const irr::core::dimension2du size = axis == 0 ? irr::core::dimension2du(place_steps, 1)
                                                       : irr::core::dimension2du(1, place_steps);
        irr::video::IImage* const image = driver_.createImage(irr::video::ECF_A8R8G8B8, size);
        for (irr::u32 step = 0; step < place_steps; ++step) {
            const irr::u32 x = axis == 0 ? step : 0;
            const irr::u32 y = axis == 0 ? 0 : step;
            image->setPixel(x, y,
                            {255, step / (channel_steps * channel_steps) * channel_step,
                             step / channel_steps % channel_steps * channel_step,
                             step % channel_steps * channel_step});
        }
        return add_texture(axis == 0 ? "columns" : "rows", image, false);
    }

    irr::scene::ISceneManager& scene_;
    irr::video::IVideoDriver& driver_;
    const Arguments& arguments_;
    float low_ = 0.0F;   // metres
    float range_ = 1.0F; // metres
    irr::video::ITexture* colors_ = nullptr;
    std::array<irr::video::ITexture*, 2> place_textures_{};
    irr::scene::IMeshSceneNode* node_ = nullptr;
};

} // namespace reljef::bench::baseline
