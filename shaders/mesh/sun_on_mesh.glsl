// The part of the sun that other meshes and ground leave on a mesh.
#include "material/mesh_shadow.glsl"
#include "material/ground_shadow.glsl"

uniform mat4 ground_shadow_place; // to texture coordinates and true height; zeros: no ground casts shadows

// Metres of true height above the shadow of ground.
float height_in_sun(vec3 relative) {
    vec3 at = (ground_shadow_place * vec4(relative, 1.0)).xyz;
    return at.z - textureLod(ground_shadow, at.xy, 0.0).x;
}

float sun_beside_ground(vec3 relative, vec3 across, vec3 down) {
    if (ground_shadow_place[3].w == 0.0) {
        return 1.0;
    }
    float height = height_in_sun(relative);
    float change = abs(height_in_sun(relative + across) - height) + abs(height_in_sun(relative + down) - height);
    return sun_above(height, change);
}

// `relative`: from the eye, world metres. `across`, `down`: its changes per pixel. A face that is turned away hides the
// sun itself.
float sun_on_mesh(vec3 relative, vec3 across, vec3 down) {
    vec3 perpendicular = cross(across, down);
    float area = length(perpendicular);
    vec3 face = area > 0.0 ? perpendicular / area : vec3(0.0);
    vec3 to_eye = perspective > 0.5 ? -relative : -view_forward.xyz;
    face *= dot(face, to_eye) < 0.0 ? -1.0 : 1.0;
    float cosine = dot(face, to_sun.xyz);
    if (cosine <= 0.0) {
        return 0.0;
    }
    float beside_meshes = sun_beside_meshes(relative, face, sqrt(max(1.0 - cosine * cosine, 0.0)));
    return beside_meshes > 0.0 ? beside_meshes * sun_beside_ground(relative, across, down) : 0.0;
}
