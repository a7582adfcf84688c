#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/gl/program.h"

namespace reljef::render {

/// All uniforms outside blocks; they change per draw. A name has one type and meaning in all
/// shaders.
struct Uniforms {
    // Terrain tiles: terrain.vert, terrain.frag.
    gl::Uniform<glm::vec3> eye{"eye"};
    gl::Uniform<glm::vec3> eye_rest{"eye_rest"};
    gl::Uniform<glm::mat3> world_from_local{"world_from_local"};
    gl::Uniform<glm::vec2> tile_sample{"tile_sample"};
    gl::Uniform<glm::vec4> eye_in_tile{"eye_in_tile"};
    gl::Uniform<glm::vec4> eye_sample{"eye_sample"};
    gl::Uniform<glm::vec4> lit_from_sample{"lit_from_sample"};       // relief.frag too
    gl::Uniform<glm::vec4> shadow_from_sample{"shadow_from_sample"}; // ground_sun.glsl
    // With a detail texture: ground.glsl, ground_color.glsl.
    gl::Uniform<glm::vec4> ground_from_sample{"ground_from_sample"};
    gl::Uniform<glm::vec3> tiles_at_eye{"tiles_at_eye"};

    // Meshes: mesh.vert, tile_vertex.glsl, relief_hull.vert; the first also in relief.vert.
    gl::Uniform<glm::mat4> relative_from_local{"relative_from_local"};
    gl::Uniform<glm::mat3> world_from_normal{"world_from_normal"};
    gl::Uniform<glm::vec3> albedo{"albedo"};
    gl::Uniform<glm::mat4> ground_shadow_place{"ground_shadow_place"}; // sun_on_mesh.glsl
    // With a detail texture: tile_surface.glsl, textured_mesh.frag, hull.glsl.
    gl::Uniform<glm::mat3> local_from_relative{"local_from_relative"};
    gl::Uniform<glm::vec4> warp_from_tile{"warp_from_tile"};
    gl::Uniform<glm::vec4> coordinate_range{"coordinate_range"};

    // Heights in a texture: relief_surface.glsl, relief_walk.glsl.
    gl::Uniform<glm::vec2> height_texel{"height_texel"};
    gl::Uniform<glm::ivec2> last_cell{"last_cell"};
    gl::Uniform<int> top_level{"top_level"};
    // Where its search space begins: relief_surface.glsl, stream_tiles.glsl, relief.frag.
    gl::Uniform<glm::ivec2> origin_cell{"origin_cell"};
    gl::Uniform<glm::vec4> origin_sample{"origin_sample"};
    gl::Uniform<float> samples_a_cell{"samples_a_cell"};

    // A terrain's relief: relief.frag.
    gl::Uniform<glm::mat3> space_from_relative{"space_from_relative"};
    gl::Uniform<glm::vec3> eye_in_space{"eye_in_space"};
    gl::Uniform<glm::vec2> texels_of_light{"texels_of_light"};
    gl::Uniform<int> has_certain_sun{"has_certain_sun"};

    // Its beams: beams.frag.
    gl::Uniform<glm::mat3> origin_of_ray{"origin_of_ray"};
    gl::Uniform<glm::mat3> direction_of_ray{"direction_of_ray"};
    gl::Uniform<float> begin_height{"begin_height"};
    gl::Uniform<float> beam_lift{"beam_lift"};

    gl::Uniform<glm::mat4> sun_clip_from_local{"sun_clip_from_local"}; // sun_depth.vert

    // With a surface shader: surface_shader.glsl.
    gl::Uniform<glm::vec3> eye_place{"eye_place"};

    gl::Uniform<float> sky_side{"sky_side"};
    gl::Uniform<glm::mat3> picture_from_world{"picture_from_world"};
    gl::Uniform<int> picture_count{"picture_count"};
};
inline constexpr Uniforms uniforms;

} // namespace reljef::render
