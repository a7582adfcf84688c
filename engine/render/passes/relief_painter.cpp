#include "engine/render/passes/relief_painter.h"

#include <algorithm>

#include <glm/matrix.hpp>

#include "engine/render/passes/beams.h"
#include "engine/render/shaders/relief_options.h"
#include "engine/render/shaders/view_values.h"

namespace reljef::render {
namespace {

// How far down the rays of each block of pixels meet nothing.
Result<void> paint_beams(const Painting& painting, const view::ReliefDraw& draw) {
    DrawState& state = painting.state;
    auto program = state.use({ShaderKind::beams});
    if (!program) {
        return program.error();
    }
    const ResidentRelief& relief = painting.residency.relief(draw);
    state.set_wireframe(false);
    set_beams(**program, relief,
              picture_rays(painting.list.camera, painting.list.size, relief.space,
                           glm::inverse(draw.world_from_local)));
    painting.beams.bind();
    gl::draw_arrays(gl::Primitive::triangles, 0, 3);
    painting.picture.bind();
    state.stats().state_changes += 3;
    ++state.stats().draws;
    return {};
}

void bind_light(gl::Program& program, const ResidentMaps& maps) {
    maps.lit.bind(0);
    if (maps.sun) {
        maps.sun->bind(3);
    }
    program.set_uniform("lit_from_sample", maps.lit_from_sample);
}

void set_heights(gl::Program& program, const ResidentRelief& relief) {
    relief.heights.bind(1);
    if (relief.greatest) {
        relief.greatest->bind(2);
        program.set_uniform("top_level", relief.greatest->levels() - 1);
    }
    if (relief.cones) {
        relief.cones->bind(4);
    }
    const glm::ivec2 samples = relief.heights.size();
    program.set_uniform("height_texel", 1.0F / glm::vec2(samples));
    program.set_uniform("last_cell", samples - 2);
}

void set_space(gl::Program& program, const scene::Camera& camera, const ReliefSpace& space,
               const glm::dmat4& world_from_local) {
    const glm::dmat3 local_from_world(glm::inverse(world_from_local));
    const glm::dvec3 eye = local_eye(camera, world_from_local);
    program.set_uniform("relative_from_local", relative_from_local(camera, world_from_local));
    program.set_uniform("box_low", glm::vec3(space.local_box.low));
    program.set_uniform("box_high", glm::vec3(space.local_box.high));
    program.set_uniform("space_from_relative",
                        glm::mat3(space.space_from_local * local_from_world));
    program.set_uniform("eye_in_space",
                        glm::vec3(space.space_from_local * eye + space.space_of_origin));
    program.set_uniform("box_begin", glm::vec3(space.box.low));
    program.set_uniform("box_end", glm::vec3(space.box.high));
    program.set_uniform("perspective", is_perspective(camera) ? 1.0F : 0.0F);
    program.set_uniform("near_depth", static_cast<float>(camera.near));
    program.set_uniform("range_of_height", glm::vec2(space.lowest, space.range));
    program.set_uniform("metres_per_unit", space.metres_per_unit);
}

// Texels of the lit map that a pixel facing the eye covers, a metre away.
float texels_per_metre_away(const Painting& painting, const view::ReliefDraw& draw,
                            const ReliefSpace& space) {
    const view::DrawList& list = painting.list;
    if (painting.hits || !is_perspective(list.camera)) {
        return 1e6F; // no limit
    }
    const ResidentMaps& maps = painting.residency.maps(*draw.terrain);
    const glm::vec2 texels_per_sample =
        glm::vec2(maps.lit_from_sample) * glm::vec2(maps.lit.size());
    const glm::vec2 texels_per_metre = texels_per_sample / glm::vec2(space.metres_per_unit);
    const glm::vec4 ray = ray_from_pixel(list.camera, list.size);
    return ray.x * std::max(texels_per_metre.x, texels_per_metre.y);
}

void set_relief(gl::Program& program, const Painting& painting, const view::ReliefDraw& draw) {
    const scene::Technique& technique = draw.terrain->material.technique;
    const ResidentRelief& relief = painting.residency.relief(draw);
    if (!painting.hits) {
        bind_light(program, painting.residency.maps(*draw.terrain));
        ++painting.state.stats().state_changes;
    }
    set_heights(program, relief);
    set_space(program, painting.list.camera, relief.space, draw.world_from_local);
    if (has_beams(technique)) {
        painting.beams.color().bind(5);
        program.set_uniform("pixels_a_block", pixels_a_beam);
    }
    set_relief_options(program, technique, reference_height(technique));
    program.set_uniform("texels_per_metre_away",
                        texels_per_metre_away(painting, draw, relief.space));
}

Result<void> paint_relief(const Painting& painting, const view::ReliefDraw& draw) {
    const scene::Technique& technique = draw.terrain->material.technique;
    DrawState& state = painting.state;
    painting.no_vertices.bind();
    if (has_beams(technique)) {
        if (auto painted = paint_beams(painting, draw); !painted) {
            return painted;
        }
    }
    auto program =
        state.use({ShaderKind::relief, painting.features | technique_features(technique)});
    if (!program) {
        return program.error();
    }
    state.set_wireframe(draw.terrain->material.wireframe);
    set_relief(**program, painting, draw);
    constexpr int box_vertices = 14; // relief.vert
    gl::draw_arrays(gl::Primitive::triangle_strip, 0, box_vertices);
    view::FrameStats& stats = state.stats();
    stats.triangles += box_vertices - 2;
    stats.state_changes += 3;
    ++stats.draws;
    ++stats.tiles;
    return {};
}

} // namespace

Result<void> paint_reliefs(const Painting& painting) {
    for (const view::ReliefDraw& draw : painting.list.reliefs) {
        // The box's far sides are seen from inside, too.
        painting.state.set_culling(gl::Culling::front);
        if (auto painted = paint_relief(painting, draw); !painted) {
            return painted;
        }
    }
    return {};
}

} // namespace reljef::render
