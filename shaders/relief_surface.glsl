// The surface a relief technique looks for, in samples: x column, y row, z height in [0,1] of the
// range.
layout(binding = 1) uniform sampler2D height_map;
uniform vec2 height_texel; // 1 / samples
#ifdef TILE
vec3 metres_per_unit = vec3(1.0); // of the search space's axes, at this fragment of a mesh
#else
uniform vec3 metres_per_unit; // of the search space's axes
#endif
// The technique's parameters, in the catalogue's order; zw: steps seen from straight above and
// along the ground.
uniform vec4 search_values;

float height_at(vec2 place) {
    return textureLod(height_map, (place + 0.5) * height_texel, 0.0).r;
}

// Whether the surface has such a place; what is beyond a tile on a mesh is the sampler's answer.
bool is_on_surface(vec2 place) {
#ifdef TILE
    return true;
#else
    vec2 last = vec2(textureSize(height_map, 0) - 1);
    return all(greaterThanEqual(place, vec2(0.0))) && all(lessThanEqual(place, last));
#endif
}
