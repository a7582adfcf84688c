// The part of the sun that ground and meshes leave on a terrain's triangles.
#include "material/mesh_shadow.glsl"
#include "material/ground_shadow.glsl"

uniform vec4 shadow_from_sample; // texture coordinate = sample · xy + zw

// `place`: sample. `relative`: from the eye, world metres. `change`: of the place per pixel, as columns.
float sun_on_triangles(vec2 place, vec3 relative, mat2 change) {
    vec2 at = place * shadow_from_sample.xy + shadow_from_sample.zw;
    vec2 across = change[0] * shadow_from_sample.xy;
    vec2 down = change[1] * shadow_from_sample.xy;
    vec3 edges = vec3(0.0);
    vec3 heights = vec3(0.0);
    for (int i = 0; i < 3; ++i) {
        vec2 beside = i == 0 ? vec2(0.0) : i == 1 ? across : down;
        vec2 found = textureGrad(ground_shadow, at + beside, across, down).xy;
        edges[i] = found.x;
        heights[i] = found.y;
    }
    vec3 above = heights - edges;
    float sun = sun_above(above.x, abs(above.y - above.x) + abs(above.z - above.x));
    return sun > 0.0 ? sun * sun_on_ground(relative) : 0.0;
}
