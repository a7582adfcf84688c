// The surface a relief technique looks for, in samples: x column, y row, z height in [0,1] of the
// range.
layout(binding = 1) uniform sampler2D height_map;
uniform vec2 height_texel;    // 1 / samples
uniform vec3 metres_per_unit; // of the search space's axes
// The technique's parameters, in the catalogue's order; zw: steps seen from straight above and
// along the ground.
uniform vec4 search_values;

float height_at(vec2 place) {
    return textureLod(height_map, (place + 0.5) * height_texel, 0.0).r;
}
