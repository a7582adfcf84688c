#include "engine/render/passes/ground_painter.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include "engine/render/passes/tile_painter.h"
#include "engine/render/shaders/relief_options.h"
#include "engine/render/shaders/view_values.h"

namespace reljef::render {
namespace {

constexpr float sunk = 1.0F; // the terrain lies at the highest of the heights

// The place of the eye, along each axis, less whole tiles: in floats the rest is as fine near the
// eye as far from the origin.
glm::vec3 tiles_at_eye(const glm::dmat4& world_from_local, const scene::Camera& camera,
                       double width) {
    return glm::vec3(glm::fract(local_eye(camera, world_from_local) / width));
}

// No colour of a tile is so dark that it has no share.
glm::vec3 divisible(glm::vec3 mean_color) {
    constexpr float darkest = 1.0F / 255.0F;
    return glm::max(mean_color, glm::vec3(darkest));
}

} // namespace

ShaderVariant ground_variant(const scene::GroundDetail& detail, view::DetailLevel level,
                             std::uint32_t features) {
    if (level == view::DetailLevel::relief) {
        return {ShaderKind::relief_terrain, features | technique_features(detail.technique)};
    }
    const std::uint32_t look = scene::looks_for_surface(detail.technique.id())
                                   ? feature_normal_map
                                   : technique_features(detail.technique);
    return {ShaderKind::textured_terrain, features | look};
}

void set_ground(gl::Program& program, const scene::TerrainNode& terrain,
                const glm::dmat4& world_from_local, const scene::Camera& camera, glm::ivec2 size,
                const TileResidency& tiles) {
    const scene::GroundDetail& detail = *terrain.detail;
    const ResidentTile& tile = tiles.tile(detail.set, ground_side());
    bind_tile(program, tile, tiles.surface(detail.set, ground_side()));
    const glm::dmat3 directions(world_from_local);
    const auto width = static_cast<float>(detail.width);
    program.set_uniform("local_from_relative", glm::mat3(glm::inverse(directions)));
    program.set_uniform("world_from_normal", world_from_normal(world_from_local));
    program.set_uniform("perspective", is_perspective(camera) ? 1.0F : 0.0F);
    program.set_uniform("near_depth", static_cast<float>(camera.near));
    program.set_uniform("side", 1.0F);
    program.set_uniform("bounded", 0.0F);
    program.set_uniform("tiles_at_eye", tiles_at_eye(world_from_local, camera, detail.width));
    program.set_uniform("tile_width", width);
    program.set_uniform("mean_color", divisible(tile.mean_color));
    program.set_uniform("metres_a_pixel", view::metres_a_pixel(camera, size));
    program.set_uniform("seen_pixels",
                        glm::vec4(view::seen_tile_pixels, view::seen_height_pixels(terrain)));
    set_tile_look(program, *detail.set, detail.scale * width, sunk);
    set_relief_options(program, over_mesh(detail.technique, sunk), 0.5);
}

} // namespace reljef::render
