#include "engine/render/passes/tile_painter.h"

#include <algorithm>
#include <limits>

namespace reljef::render {

void bind_tile(gl::Program& program, const ResidentTile& tile, const ResidentSurface& surface) {
    tile.color.bind(0);
    surface.heights.bind(1);
    if (surface.greatest) {
        surface.greatest->bind(2);
        program.set_uniform("top_level", surface.greatest->levels() - 1);
    }
    tile.normals.bind(4);
    if (surface.normals) {
        surface.normals->along_u.bind(4);
        surface.normals->along_v.bind(5);
    }
    if (surface.cones) {
        surface.cones->bind(6);
    }
    program.set_uniform("height_texel", 1.0F / glm::vec2(surface.heights.size()));
    program.set_uniform("last_cell", surface.cells - 1);
    program.set_uniform("rms_rise", surface.rms_rise);
}

void set_tile_look(gl::Program& program, const material::TextureSet& set, float lift,
                   float mesh_height) {
    program.set_uniform("lift", std::max(lift, std::numeric_limits<float>::min()));
    program.set_uniform("mesh_height", mesh_height);
    program.set_uniform("normal_scale", set.scale);
    program.set_uniform("shine", glm::vec2(set.specular, set.shininess));
}

scene::Technique over_mesh(scene::Technique technique, float mesh_height) {
    if (double* const offset = scene::parallax_offset(technique.parameters)) {
        *offset = -static_cast<double>(mesh_height);
    }
    return technique;
}

} // namespace reljef::render
