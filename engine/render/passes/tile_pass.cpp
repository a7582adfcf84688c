#include "engine/render/passes/tile_pass.h"

#include <algorithm>
#include <limits>

#include "engine/render/shaders/bindings.h"
#include "engine/render/shaders/relief_options.h"
#include "engine/render/shaders/shader_library.h"
#include "engine/render/shaders/uniforms.h"

namespace reljef::render {

void bind_tile(gl::Program& program, const ResidentTile& tile, const ResidentSurface& surface) {
    tile.color.bind(bindings::color_map_unit);
    surface.heights.bind(bindings::height_map_unit);
    if (surface.max_mipmap) {
        surface.max_mipmap->bind(bindings::max_mipmap_unit);
        program.set(uniforms.top_level, surface.max_mipmap->levels() - 1);
    }
    tile.normals.bind(bindings::normal_map_unit);
    if (surface.normals) {
        surface.normals->along_u.bind(bindings::normal_map_unit);
        surface.normals->along_v.bind(bindings::normal_map_v_unit);
    }
    if (surface.cones) {
        surface.cones->bind(bindings::cone_map_unit);
    }
    program.set(uniforms.height_texel, 1.0F / glm::vec2(surface.heights.size()));
    program.set(uniforms.last_cell, surface.cells - 1);
}

DetailBlock detail_block(const material::ReliefMaterial& set, const ResidentSurface& surface,
                         float lift, float mesh_height) {
    DetailBlock block{};
    block.detail_heights = {std::max(lift, std::numeric_limits<float>::min()), mesh_height,
                            set.scale, 1.0F};
    block.detail_look = {set.specular, set.shininess, surface.rms_rise.x, surface.rms_rise.y};
    return block;
}

scene::Technique over_mesh(scene::Technique technique, float mesh_height) {
    if (double* const offset = scene::parallax_offset(technique.parameters)) {
        *offset = -static_cast<double>(mesh_height);
    }
    return technique;
}

} // namespace reljef::render
