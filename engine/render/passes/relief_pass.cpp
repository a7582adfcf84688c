#include "engine/render/passes/frame_context.h"

#include <algorithm>
#include <cmath>

#include <glm/matrix.hpp>

#include "engine/core/geometry.h"
#include "engine/render/passes/beams.h"
#include "engine/render/passes/course_block.h"
#include "engine/render/passes/overlay_pass.h"
#include "engine/render/shaders/bindings.h"
#include "engine/render/shaders/relief_options.h"
#include "engine/render/shaders/surface_constants.h"
#include "engine/render/shaders/uniforms.h"
#include "engine/render/shaders/view_values.h"

namespace reljef::render {
namespace {

ShaderFeatures surface_features(const view::TerrainDraw& draw) {
    const auto& course = draw.search->course;
    return (is_streamed(draw) ? feature_streamed : 0U) | (course ? feature_curved : 0U) |
           (course && course->needs_quartic ? feature_quartic : 0U) |
           (course && course->degrees ? feature_degrees : 0U);
}

DrawnSpace space_of(const FrameContext& frame, const view::TerrainDraw& draw) {
    if (is_streamed(draw)) {
        const StreamedSpace& streamed = frame.residency.relief_tiles().tiles(draw).space;
        return {streamed.space, streamed.origin, streamed.origin_sample, streamed.samples_a_cell};
    }
    const ReliefSpace& whole = frame.residency.relief(draw).space;
    const glm::dvec3 eye =
        draw.search->course
            ? draw.search->course->eye
            : whole.space_from_local * local_eye(frame.list.camera, draw.world_from_local) +
                  whole.space_of_origin;
    const glm::dvec2 origin =
        origin_near(glm::dvec2(eye), glm::dvec2(whole.box.high), draw.search->course);
    return {moved_to(whole, origin), glm::ivec2(origin), origin, 1.0};
}

Box local_box(const view::TerrainDraw& draw, const ReliefSpace& space) {
    if (!draw.search->course) {
        return space.local_box;
    }
    const Box visible = visible_samples(draw, space);
    return terrain::placed_bounds(draw.terrain->surface->placement(), glm::dvec2(visible.low),
                                  glm::dvec2(visible.high), {visible.low.z, visible.high.z});
}

// What the picture may show of a box: where the eye is inside a box much larger than what it sees,
// corners cut at the picture's border would be rounded by pixels.
Box seen_part(const Box& local, const scene::Camera& camera, glm::ivec2 size,
              const glm::dmat4& world_from_local) {
    if (!is_perspective(camera)) {
        return local;
    }
    const glm::dmat4 local_from_world = glm::inverse(world_from_local);
    const glm::dvec3 eye = local_eye(camera, world_from_local);
    constexpr double rounding = 0x1p-20; // of the box, as floats
    const glm::dvec3 beside =
        rounding * glm::max(glm::abs(local.low), glm::abs(local.high)) + camera.near;
    Box part{eye - beside, eye + beside};
    const glm::dvec2 low(-1.0); // samples of a pixel are seen beside its middle
    const glm::dvec2 high = glm::dvec2(size) + 1.0;
    for (const glm::dvec2 corner :
         {low, glm::dvec2(high.x, low.y), glm::dvec2(low.x, high.y), high}) {
        const glm::dvec3 way(local_from_world *
                             glm::dvec4(scene::view_ray(camera, size, corner).direction, 0.0));
        for (int axis = 0; axis < 3; ++axis) {
            (way[axis] < 0.0 ? part.low : part.high)[axis] =
                (way[axis] < 0.0 ? local.low : local.high)[axis];
        }
    }
    return {glm::max(part.low, local.low), glm::min(part.high, local.high)};
}

ReliefBlock relief_block(const FrameContext& frame, const view::TerrainDraw& draw,
                         const ReliefSpace& space) {
    const Box local = seen_part(local_box(draw, space), frame.list.camera, frame.list.size,
                                draw.world_from_local);
    return {.box_low = glm::vec4(glm::vec3(local.low), 0.0F),
            .box_high = glm::vec4(glm::vec3(local.high), 0.0F),
            .box_begin = glm::vec4(glm::vec3(space.box.low), 0.0F),
            .box_end = glm::vec4(glm::vec3(space.box.high), 0.0F),
            .space_scale = glm::vec4(space.metres_per_unit, 0.0F),
            .height_span = glm::vec4(space.lowest, space.range, 1.0 / space.range, 0.0)};
}

void set_origin(gl::Program& program, const DrawnSpace& drawn) {
    program.set(uniforms.origin_cell, drawn.origin);
    const SplitPoint origin = split_into_floats(glm::dvec3(drawn.origin_sample, 0.0));
    program.set(uniforms.origin_sample,
                glm::vec4(origin.rounded.x, origin.rounded.y, origin.rest.x, origin.rest.y));
    program.set(uniforms.samples_a_cell, static_cast<float>(drawn.samples_a_cell));
}

bool uses_beams(const FrameContext& frame, const view::TerrainDraw& draw) {
    const auto& course = draw.search->course;
    return frame.skips.beams && has_beams(draw.search->technique) && !(course && course->degrees);
}

void set_own_heights(gl::Program& program, const ResidentRelief& relief) {
    relief.heights.bind(bindings::height_map_unit);
    if (relief.max_mipmap) {
        relief.max_mipmap->bind(bindings::max_mipmap_unit);
        program.set(uniforms.top_level, relief.max_mipmap->levels() - 1);
    }
    if (relief.cones) {
        relief.cones->bind(bindings::relief_cone_map_unit);
    }
    const glm::ivec2 samples = relief.heights.size();
    program.set(uniforms.height_texel, 1.0F / glm::vec2(samples));
    program.set(uniforms.last_cell, samples - 2);
}

void set_streamed_heights(gl::Program& program, const ResidentReliefTiles& tiles) {
    tiles.heights->bind(bindings::height_map_unit);
    tiles.pages->bind(bindings::pages_unit);
    if (tiles.max_mipmaps) {
        tiles.max_mipmaps->bind(bindings::max_mipmap_unit);
    }
    if (tiles.cones) {
        tiles.cones->bind(bindings::relief_cone_map_unit);
    }
    const int levels_of_tile = tiles.max_mipmaps ? tiles.max_mipmaps->levels() : 1;
    program.set(uniforms.top_level, levels_of_tile + tiles.pages->levels() - 2);
    program.set(uniforms.height_texel, 1.0F / glm::vec2(tiles.heights->size()));
    program.set(uniforms.last_cell, tiles.space.last_cell);
}

void set_heights(gl::Program& program, const FrameContext& frame, const view::TerrainDraw& draw) {
    if (is_streamed(draw)) {
        set_streamed_heights(program, frame.residency.relief_tiles().tiles(draw));
    } else {
        set_own_heights(program, frame.residency.relief(draw));
    }
}

Result<void> draw_beams(const FrameContext& frame, const view::TerrainDraw& draw) {
    DrawState& state = frame.state;
    state.set_adding(false);
    auto program = state.use(
        {ShaderKind::beams, surface_features(draw) | (frame.features & feature_counting)});
    if (!program) {
        return program.error();
    }
    const DrawnSpace drawn = space_of(frame, draw);
    const ReliefSpace& space = drawn.space;
    state.set_wireframe(false);
    set_heights(**program, frame, draw);
    set_origin(**program, drawn);
    if (auto set = state.set(relief_block(frame, draw, space)); !set) {
        return set;
    }
    if (draw.search->course) {
        if (auto set = state.set(course_block(draw, drawn, frame.list)); !set) {
            return set;
        }
        const ReliefSpace world;
        set_beams(**program, space,
                  picture_rays(frame.list.camera, frame.list.size, world, glm::dmat4(1.0)));
    } else {
        set_beams(**program, space,
                  picture_rays(frame.list.camera, frame.list.size, space,
                               glm::inverse(draw.world_from_local)));
    }
    frame.beams.bind();
    gl::draw_arrays(gl::Primitive::triangles, 3);
    frame.picture.bind();
    state.stats().state_changes += 3;
    ++state.stats().draws;
    return {};
}

void bind_light(gl::Program& program, const FrameContext& frame, const view::TerrainDraw& draw) {
    if (is_streamed(draw)) {
        const ResidentReliefTiles& tiles = frame.residency.relief_tiles().tiles(draw);
        tiles.lit->bind(bindings::lit_map_unit);
        if (tiles.sun) {
            tiles.sun->bind(bindings::sun_map_unit);
        }
        return;
    }
    const ResidentMaps& maps = frame.residency.maps(*draw.terrain);
    maps.lit.bind(bindings::lit_map_unit);
    if (maps.sun) {
        maps.sun->bind(bindings::sun_map_unit);
    }
    program.set(uniforms.lit_from_sample, maps.lit_from_sample);
}

// For the light of points.
void bind_lit_ground(gl::Program& program, const FrameContext& frame,
                     const view::TerrainDraw& draw) {
    if (point_light_features(frame, draw) == 0) {
        return;
    }
    if (is_streamed(draw)) {
        const ResidentReliefTiles& tiles = frame.residency.relief_tiles().tiles(draw);
        tiles.albedo->bind(bindings::lit_albedo_unit);
        tiles.normals->bind(bindings::lit_normals_unit);
    } else {
        const ResidentGround& ground = frame.residency.ground().ground(*draw.terrain);
        ground.albedo.bind(bindings::lit_albedo_unit);
        ground.surface.bind(bindings::lit_normals_unit);
    }
    program.set(uniforms.world_from_normal, world_from_normal(draw.world_from_local));
    ++frame.state.stats().state_changes;
}

void set_space(gl::Program& program, const scene::Camera& camera, const ReliefSpace& space,
               const glm::dmat4& world_from_local) {
    const glm::dmat3 local_from_world(glm::inverse(world_from_local));
    const glm::dvec3 eye = local_eye(camera, world_from_local);
    program.set(uniforms.relative_from_local, relative_from_local(camera, world_from_local));
    program.set(uniforms.space_from_relative, glm::mat3(space.space_from_local * local_from_world));
    program.set(uniforms.eye_in_space,
                glm::vec3(space.space_from_local * eye + space.space_of_origin));
}

// Texels of the lit map in a unit of the search space.
glm::vec2 texels_in_space(const FrameContext& frame, const view::TerrainDraw& draw) {
    if (is_streamed(draw)) {
        return glm::vec2(1.0F); // relief_light.glsl counts cells
    }
    const ResidentMaps& maps = frame.residency.maps(*draw.terrain);
    return glm::vec2(maps.lit_from_sample) * glm::vec2(maps.lit.size());
}

// Texels of the lit map per pixel at the eye, and per metre of distance, by their larger side: near
// poles the other one would blur over dozens of pixels.
glm::vec2 texels_of_light(const FrameContext& frame, const view::TerrainDraw& draw,
                          const ReliefSpace& space) {
    const view::DrawList& list = frame.list;
    if (frame.hits) {
        return {1e6F, 0.0F};
    }
    const glm::vec2 texels_per_metre =
        texels_in_space(frame, draw) / glm::vec2(space.metres_per_unit);
    return std::min(texels_per_metre.x, texels_per_metre.y) *
           scene::metres_a_pixel(list.camera, list.size);
}

void set_certain_sun(gl::Program& program, const FrameContext& frame,
                     const view::TerrainDraw& draw) {
    const gl::Texture2D* const map = frame.skips.certain && !frame.hits && !is_streamed(draw)
                                         ? frame.residency.certain_sun(draw)
                                         : nullptr;
    if (map != nullptr) {
        map->bind(bindings::certain_sun_unit);
    }
    program.set(uniforms.has_certain_sun, map != nullptr ? 1 : 0);
}

Result<void> set_relief(gl::Program& program, const FrameContext& frame,
                        const view::TerrainDraw& draw) {
    const scene::Technique& technique = draw.search->technique;
    const DrawnSpace drawn = space_of(frame, draw);
    const ReliefSpace& space = drawn.space;
    if (!frame.hits) {
        bind_light(program, frame, draw);
        bind_lit_ground(program, frame, draw);
        ++frame.state.stats().state_changes;
    }
    set_heights(program, frame, draw);
    if (!frame.skips.blocks) {
        program.set(uniforms.top_level, 0);
    }
    set_certain_sun(program, frame, draw);
    set_origin(program, drawn);
    if (auto set = set_overlay(frame, *draw.terrain, draw.world_from_local, &space); !set) {
        return set;
    }
    set_space(program, frame.list.camera, space, draw.world_from_local);
    if (draw.search->course) {
        if (auto set = frame.state.set(course_block(draw, drawn, frame.list)); !set) {
            return set;
        }
    }
    if (uses_beams(frame, draw)) {
        frame.beams.color().bind(bindings::clear_heights_unit);
    }
    program.set(uniforms.texels_of_light, texels_of_light(frame, draw, space));
    if (auto set = frame.state.set(relief_block(frame, draw, space)); !set) {
        return set;
    }
    return frame.state.set(technique_block(technique, reference_height(technique)));
}

// Meshes are tested against the depth of the box unless the hit's is written.
ShaderFeatures depth_features(const FrameContext& frame, const scene::Technique& technique) {
    const bool is_needed = technique.options.depth == scene::HitDepth::objects &&
                           !frame.list.meshes.empty() && !frame.counts();
    return is_needed ? feature_write_depth : 0U;
}

Result<void> draw_relief(const FrameContext& frame, const view::TerrainDraw& draw) {
    const scene::Technique& technique = draw.search->technique;
    DrawState& state = frame.state;
    frame.no_vertices.bind();
    if (uses_beams(frame, draw)) {
        if (auto drawn = draw_beams(frame, draw); !drawn) {
            return drawn;
        }
    }
    const ShaderFeatures unused = uses_beams(frame, draw) ? 0U : feature_beams;
    const ShaderFeatures features = frame.features | (technique_features(technique) & ~unused) |
                                    depth_features(frame, technique) | surface_features(draw) |
                                    overlay_features(frame, *draw.terrain) |
                                    point_light_features(frame, draw) | frame.mesh_shadows;
    const scene::Material& material = draw.terrain->material;
    auto program = state.use(with_surface({ShaderKind::relief, features}, material));
    if (!program) {
        return program.error();
    }
    set_surface(**program, material, frame.list.camera);
    state.set_wireframe(material.wireframe);
    state.set_adding(frame.counts());
    if (auto set = set_relief(**program, frame, draw); !set) {
        return set;
    }
    constexpr int box_vertices = 14; // relief.vert
    gl::draw_arrays(gl::Primitive::triangle_strip, box_vertices);
    view::FrameStats& stats = state.stats();
    stats.triangles += box_vertices - 2;
    stats.state_changes += 3;
    ++stats.draws;
    stats.tiles += std::max<int>(1, static_cast<int>(draw.search->tiles.size()));
    return {};
}

} // namespace

Result<void> draw_reliefs(const FrameContext& frame) {
    for (const view::TerrainDraw* const draw : view::searched_terrains(frame.list)) {
        // The eye may be inside the box: draw its far sides.
        frame.state.set_culling(gl::Culling::front);
        if (auto drawn = draw_relief(frame, *draw); !drawn) {
            return drawn;
        }
    }
    return {};
}

} // namespace reljef::render
