#include "engine/render/passes/ground_pass.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include "engine/render/passes/tile_pass.h"
#include "engine/render/shaders/relief_options.h"
#include "engine/render/shaders/uniforms.h"
#include "engine/render/shaders/view_values.h"

namespace reljef::render {
namespace {

constexpr float top_height = 1.0F; // the terrain carries the detail's highest places

// The eye's position modulo a tile: keeps float precision far from the origin.
glm::vec3 tiles_at_eye(const glm::dmat4& world_from_local, const scene::Camera& camera,
                       double width) {
    return glm::vec3(glm::fract(local_eye(camera, world_from_local) / width));
}

glm::vec3 divisible(glm::vec3 mean_color) {
    constexpr float darkest = 1.0F / 255.0F;
    return glm::max(mean_color, glm::vec3(darkest));
}

} // namespace

ShaderVariant ground_variant(const scene::TerrainDetail& detail, view::DetailLevel level,
                             ShaderFeatures features) {
    if (level == view::DetailLevel::relief) {
        return {ShaderKind::relief_terrain, features | technique_features(detail.technique)};
    }
    const ShaderFeatures look = scene::searches_surface(detail.technique.id())
                                    ? feature_normal_map
                                    : technique_features(detail.technique);
    return {ShaderKind::textured_terrain, features | look};
}

Result<void> set_ground(gl::Program& program, const FrameContext& frame,
                        const scene::TerrainNode& terrain, const glm::dmat4& world_from_local) {
    const scene::TerrainDetail& detail = *terrain.detail;
    const TileResidency& tiles = frame.residency.ground().tiles();
    const ResidentTile& tile = tiles.tile(detail.set, ground_side());
    const ResidentSurface& surface = tiles.surface(detail.set, ground_side());
    bind_tile(program, tile, surface);
    const glm::dmat3 directions(world_from_local);
    program.set(uniforms.local_from_relative, glm::mat3(glm::inverse(directions)));
    program.set(uniforms.world_from_normal, world_from_normal(world_from_local));
    program.set(uniforms.tiles_at_eye,
                tiles_at_eye(world_from_local, frame.list.camera, detail.width));
    const auto width = static_cast<float>(detail.width);
    DetailBlock block = detail_block(*detail.set, surface, detail.scale * width, top_height);
    block.detail_repeats.z = width;
    block.mean_color = glm::vec4(divisible(tile.mean_color), 0.0F);
    block.seen_pixels = glm::vec4(view::seen_tile_pixels, view::seen_height_pixels(terrain));
    if (auto set = frame.state.set(block); !set) {
        return set;
    }
    return frame.state.set(technique_block(over_mesh(detail.technique, top_height), 0.5));
}

} // namespace reljef::render
