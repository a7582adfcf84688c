#include "engine/scene/streaming/ground_overlay.h"

#include <cstdint>

#include <glm/common.hpp>
#include <glm/vec4.hpp>

#include "engine/core/bilinear.h"
#include "engine/terrain/field/tint.h"

namespace reljef::scene {
namespace {

constexpr float max_byte = 255.0F;

// Channels of the same weight: a texel without colour does not darken its neighbours.
glm::vec4 weighted(Rgba8 color) {
    const float alpha = static_cast<float>(color.a) / max_byte;
    return {alpha * glm::vec3(color.r, color.g, color.b), alpha};
}

// `place`: [0, 1] along both sides of the overlay.
void blend_texel(Rgba8& color, const Image& overlay, glm::dvec2 place) {
    const glm::dvec2 last(overlay.cols() - 1, overlay.rows() - 1);
    const glm::dvec2 texel = glm::clamp(place, glm::dvec2(0.0), glm::dvec2(1.0)) * last;
    const glm::vec4 over = bilinear(overlay, texel, weighted);
    if (over.a > 0.0F) {
        const glm::vec3 shown = glm::vec3(over) / over.a + 0.5F;
        color =
            terrain::mixed(color,
                           {static_cast<std::uint8_t>(shown.r), static_cast<std::uint8_t>(shown.g),
                            static_cast<std::uint8_t>(shown.b), 255},
                           over.a);
    }
}

} // namespace

void blend_overlay(const TerrainSurface& surface, Image& colors) {
    if (surface.overlay() == nullptr) {
        return;
    }
    const glm::dvec2 last(colors.cols() - 1, colors.rows() - 1);
    for (int row = 0; row < colors.rows(); ++row) {
        for (int col = 0; col < colors.cols(); ++col) {
            blend_texel(colors(col, row), *surface.overlay(), glm::dvec2(col, row) / last);
        }
    }
}

void blend_overlay(const TileBuilder& builder, TerrainTile& tile, glm::ivec2 vertex) {
    const TerrainSurface& surface = builder.overview();
    if (surface.overlay() == nullptr) {
        return;
    }
    const Grid<float>& heights = surface.heightfield().heights;
    const glm::dvec2 last(heights.cols() - 1, heights.rows() - 1);
    const glm::dvec2 first = builder.on_overview(builder.sample(tile.id, vertex));
    const glm::dvec2 end = builder.on_overview(builder.sample(tile.id, vertex + tile.cells));
    const glm::dvec2 step = (end - first) / glm::dvec2(tile.cells);
    for (int row = 0; row < tile.albedo.rows(); ++row) {
        for (int col = 0; col < tile.albedo.cols(); ++col) {
            const glm::dvec2 sample = first + step * tile.vertex_of({col, row});
            blend_texel(tile.albedo(col, row), *surface.overlay(),
                        builder.around_overview(sample) / last);
        }
    }
}

} // namespace reljef::scene
