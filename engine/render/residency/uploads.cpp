#include "engine/render/residency/uploads.h"

#include <algorithm>
#include <utility>

#include <glm/common.hpp>

#include "engine/render/triangles/resident_mesh.h"

namespace reljef::render {

Result<gl::Texture2D> upload_texture(const gl::TextureOptions& options,
                                     std::span<const std::byte> texels, view::FrameStats& stats) {
    auto texture = gl::Texture2D::create(options);
    if (texture) {
        texture->upload(0, texels);
        texture->generate_mipmaps();
        count_upload(stats, texture->bytes());
    }
    return texture;
}

Result<gl::Texture2D> upload_levels(const std::vector<Grid<float>>& levels,
                                    view::FrameStats& stats) {
    auto texture = gl::Texture2D::create({.size = {levels.front().cols(), levels.front().rows()},
                                          .format = gl::Format::r32f,
                                          .levels = gl::full_chain,
                                          .filter = gl::Filter::nearest});
    if (texture) {
        for (std::size_t level = 0; level < levels.size(); ++level) {
            texture->upload(static_cast<int>(level), levels[level]);
        }
        count_upload(stats, texture->bytes());
    }
    return texture;
}

Result<gl::Texture2D> upload_places(const Grid<glm::vec4>& places, gl::Texture2D& last,
                                    view::FrameStats& stats) {
    if (last.size() != glm::ivec2(places.cols(), places.rows())) {
        return upload_grid(places, {.format = gl::Format::rgba32f, .filter = gl::Filter::nearest},
                           stats);
    }
    last.upload(0, places);
    count_upload(stats, last.bytes());
    return std::move(last);
}

Result<void> keep(Result<gl::Texture2D> made, std::optional<gl::Texture2D>& place) {
    if (!made) {
        return made.error();
    }
    place = std::move(*made);
    return {};
}

Grid<glm::i16vec4> snorm16(const Grid<glm::vec4>& values) {
    Grid<glm::i16vec4> packed(values.cols(), values.rows());
    std::ranges::transform(values.samples(), packed.samples().begin(), [](const glm::vec4& value) {
        return glm::i16vec4(glm::round(value * 32767.0F));
    });
    return packed;
}

} // namespace reljef::render
