// Lights at places, without shadows.
layout(std140, binding = point_light_block_binding) uniform PointLightBlock {
#include "material/point_lights.inc"
};

// Linear radiance at albedo 1. `relative`: from the eye, world metres; `normal`: unit vector in the world.
vec3 light_of_points(vec3 relative, vec3 normal) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < int(point_light_numbers.x); ++i) {
        vec3 way = point_light_places[i].xyz - relative;
        float square = max(dot(way, way), point_light_numbers.y);
        float part = square * point_light_places[i].w; // (distance / range)^2
        float window = max(1.0 - part * part, 0.0);
        float facing = max(dot(normal, way), 0.0) * inversesqrt(square);
        sum += point_light_colors[i].rgb * (facing * window * window / square);
    }
    return sum;
}
