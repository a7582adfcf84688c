#include "engine/render/residency/uploads.h"

#include <utility>

#include "engine/render/residency/resident_mesh.h"

namespace reljef::render {

Result<gl::Texture2D> mipmapped(glm::ivec2 size, gl::Format format,
                                std::span<const std::byte> texels, view::FrameStats& stats,
                                gl::Wrap wrap) {
    auto texture = gl::Texture2D::create({.size = size,
                                          .format = format,
                                          .levels = gl::full_chain,
                                          .filter = gl::Filter::trilinear,
                                          .wrap = wrap});
    if (texture) {
        texture->upload(0, texels);
        texture->generate_mipmaps();
        count_upload(stats, texture->bytes());
    }
    return texture;
}

Result<gl::Texture2D> height_texture(const Grid<float>& heights, view::FrameStats& stats) {
    auto texture = gl::Texture2D::create(
        {.size = {heights.cols(), heights.rows()}, .format = gl::Format::r32f});
    if (texture) {
        texture->upload(0, heights);
        count_upload(stats, texture->bytes());
    }
    return texture;
}

Result<gl::Texture2D> tile_height_texture(const Grid<float>& heights, gl::Wrap wrap,
                                          view::FrameStats& stats) {
    auto texture = gl::Texture2D::create({.size = {heights.cols(), heights.rows()},
                                          .format = gl::Format::r32f,
                                          .levels = gl::full_chain,
                                          .wrap = wrap});
    if (texture) {
        texture->upload(0, heights);
        texture->generate_mipmaps();
        count_upload(stats, texture->bytes());
    }
    return texture;
}

Result<gl::Texture2D> pyramid_texture(const std::vector<Grid<float>>& levels,
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

Result<gl::Texture2D> place_texture(glm::ivec2 size, gl::Texture2D& before) {
    if (before.size() == size) {
        return std::move(before);
    }
    return gl::Texture2D::create(
        {.size = size, .format = gl::Format::rgba32f, .filter = gl::Filter::nearest});
}

Result<void> keep(Result<gl::Texture2D> made, std::optional<gl::Texture2D>& place) {
    if (!made) {
        return made.error();
    }
    place = std::move(*made);
    return {};
}

} // namespace reljef::render
