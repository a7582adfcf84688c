#include "engine/render/residency/resident_tile.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/gtc/type_precision.hpp>

#include "engine/material/tile_cones.h"
#include "engine/render/residency/relief_maps.h"
#include "engine/render/residency/uploads.h"

namespace reljef::render {
namespace {

gl::Wrap wrap_of(bool wraps) {
    return wraps ? gl::Wrap::repeat : gl::Wrap::clamp;
}

material::WrapMode border_as(bool wraps) {
    return wraps ? material::WrapMode::wrap : material::WrapMode::clamp;
}

// Linear.
glm::vec3 mean_of(const Image& picture) {
    glm::dvec3 sum(0.0);
    for (const Rgba8 texel : picture.samples()) {
        sum += glm::dvec3(linear_from_rgba8(texel));
    }
    return glm::vec3(sum / static_cast<double>(picture.size()));
}

// x and y of the normals as rg16_snorm.
Grid<glm::i16vec2> packed_normals(const Grid<glm::vec3>& normals) {
    Grid<glm::i16vec2> packed(normals.cols(), normals.rows());
    std::ranges::transform(normals.samples(), packed.samples().begin(),
                           [](const glm::vec3& normal) {
                               return glm::i16vec2(glm::round(glm::vec2(normal) * 32767.0F));
                           });
    return packed;
}

// wraps: repeats the first heights behind the last. At least one cell.
Grid<float> with_next_copies(const Grid<float>& heights, bool wraps) {
    const int more = wraps ? 1 : 0;
    Grid<float> all(std::max(heights.cols() + more, 2), std::max(heights.rows() + more, 2));
    for (int row = 0; row < all.rows(); ++row) {
        for (int col = 0; col < all.cols(); ++col) {
            all(col, row) = wraps ? heights(col % heights.cols(), row % heights.rows())
                                  : heights.clamped(col, row);
        }
    }
    return all;
}

glm::ivec2 cells_of(int cols, int rows, bool wraps) {
    return wraps ? glm::ivec2(cols, rows)
                 : glm::ivec2(std::max(cols, 2) - 1, std::max(rows, 2) - 1);
}

glm::vec2 rms_rise(const Grid<float>& heights, bool wraps) {
    const Grid<float> all = with_next_copies(heights, wraps);
    glm::dvec2 sum(0.0);
    for (int row = 0; row + 1 < all.rows(); ++row) {
        for (int col = 0; col + 1 < all.cols(); ++col) {
            const glm::dvec2 rise(all(col + 1, row) - all(col, row),
                                  all(col, row + 1) - all(col, row));
            sum += rise * rise;
        }
    }
    return glm::vec2(glm::sqrt(sum / static_cast<double>((all.cols() - 1) * (all.rows() - 1))));
}

std::shared_ptr<const material::ConeMaps> known_cones(const material::ReliefMaterial& set,
                                                      const TileSide& side) {
    const auto found =
        std::find_if(set.cones.begin(), set.cones.end(), [&](const material::KnownCones& known) {
            return known.border == border_as(side.wraps) && known.from_behind == side.from_behind;
        });
    return found == set.cones.end() ? nullptr : found->of_field;
}

Result<gl::Texture2D> layer_normal_texture(const Grid<glm::vec4>& component, bool wraps,
                                           view::FrameStats& stats) {
    return upload_mipmapped(snorm16(component), gl::Format::rgba16_snorm, stats, wrap_of(wraps));
}

Result<ResidentSurface> resident_layers(const material::ReliefMaterial& set, const TileSide& side,
                                        view::FrameStats& stats) {
    material::LayerMap layers = material::layers_of(set, *side.layers);
    if (side.from_behind) {
        layers = material::seen_from_behind(layers);
    }
    const auto normals = material::layer_normals(layers, set.scale, border_as(side.wraps));
    auto heights = upload_grid(layers.heights(),
                               {.format = gl::Format::rgba32f, .wrap = wrap_of(side.wraps)}, stats);
    if (!heights) {
        return heights.error();
    }
    auto along_u = layer_normal_texture(normals.along_u, side.wraps, stats);
    if (!along_u) {
        return along_u.error();
    }
    auto along_v = layer_normal_texture(normals.along_v, side.wraps, stats);
    if (!along_v) {
        return along_v.error();
    }
    ResidentSurface surface;
    surface.heights = std::move(*heights);
    surface.cells = cells_of(layers.heights().cols(), layers.heights().rows(), side.wraps);
    surface.normals = LayerTextures{std::move(*along_u), std::move(*along_v)};
    return surface;
}

} // namespace

Result<ResidentTile> resident_tile(const material::ReliefMaterial& set, bool wraps,
                                   view::FrameStats& stats) {
    auto color = upload_mipmapped(set.color, gl::Format::rgba8_srgb, stats, wrap_of(wraps));
    if (!color) {
        return color.error();
    }
    auto normals = upload_mipmapped(packed_normals(set.normals), gl::Format::rg16_snorm, stats,
                                    wrap_of(wraps));
    if (!normals) {
        return normals.error();
    }
    return ResidentTile{std::move(*color), std::move(*normals), mean_of(set.color)};
}

Result<ResidentSurface> resident_surface(const material::ReliefMaterial& set, const TileSide& side,
                                         view::FrameStats& stats) {
    if (side.layers) {
        return resident_layers(set, side, stats);
    }
    const Grid<float> shown = material::visible_heights(set.heights, side.from_behind);
    auto heights = upload_grid(
        shown, {.format = gl::Format::r32f, .levels = gl::full_chain, .wrap = wrap_of(side.wraps)},
        stats);
    if (!heights) {
        return heights.error();
    }
    ResidentSurface surface;
    surface.heights = std::move(*heights);
    surface.cells = cells_of(shown.cols(), shown.rows(), side.wraps);
    surface.rms_rise = rms_rise(shown, side.wraps);
    return surface;
}

Result<gl::Texture2D> max_mipmap_texture(const material::ReliefMaterial& set, const TileSide& side,
                                         view::FrameStats& stats) {
    const Grid<float> heights =
        with_next_copies(material::visible_heights(set.heights, side.from_behind), side.wraps);
    return upload_levels(max_mipmap(heights.view()), stats);
}

Result<gl::Texture2D> tile_cone_texture(const material::ReliefMaterial& set, const TileSide& side,
                                        view::FrameStats& stats) {
    const material::WrapMode border = border_as(side.wraps);
    const Grid<float> heights = material::visible_heights(set.heights, side.from_behind);
    const Grid<float> field = material::cone_field(heights.view(), border);
    const auto known = known_cones(set, side);
    const material::ConeMaps cones =
        material::tile_cones(known ? *known : *material::cone_maps(field.view()), heights.cols(),
                             heights.rows(), border);
    Grid<glm::vec2> texels(cones.plain.cols(), cones.plain.rows());
    std::ranges::transform(cones.plain.samples(), cones.relaxed.samples(), texels.samples().begin(),
                           [](float plain, float relaxed) { return glm::vec2(plain, relaxed); });
    return upload_grid(texels, {.format = gl::Format::rg32f, .filter = gl::Filter::nearest}, stats);
}

} // namespace reljef::render
