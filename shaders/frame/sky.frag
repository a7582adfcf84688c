#include "frame/frame_block.glsl"
#include "frame/air.glsl"

#ifdef SKY_PICTURE
layout(binding = sky_faces_unit) uniform sampler2D sky_faces; // of material::SkyPicture::Level
uniform mat3 picture_from_world; // a rotation
uniform float sky_side; // texels along a face without its border
#endif

in vec3 ray;

layout(location = 0) out vec4 color;

// Of the plane at the base, below the horizon, behind scene::plane_air(). `fall`: > 0, see
// scene::steepness_to_plane().
vec3 plane_color(vec3 direction, float fall) {
#ifdef FOG
    float horizon = 4.0 * air_up.w * sky_plane.a;
    float steepness = 0.5 * (fall + sqrt(max(fall * fall - horizon, 0.0)));
    vec3 left = exp(-air.rgb * (sky_horizon.a / steepness));
    return mix(haze_color(direction), sky_plane.rgb, left);
#else
    return sky_plane.rgb;
#endif
}

#ifdef SKY_PICTURE
// As material::SkyPicture::color().
vec3 sky_color(vec3 world_direction) {
    vec3 direction = picture_from_world * world_direction;
    vec3 size = abs(direction);
    bool along_x = size.x >= size.y;
    float level = along_x ? direction.x : direction.y;
    bool upright = abs(level) < size.z;
    float axis = upright ? direction.z : level;
    float face = (upright ? 4.0 : along_x ? 0.0 : 2.0) + (axis < 0.0 ? 1.0 : 0.0);
    vec2 across = vec2(upright || !along_x ? direction.x : direction.y, upright ? direction.y : direction.z);
    vec2 texel = 0.5 * sky_side * (across / abs(axis) + 1.0) + 1.0;
    texel.y += face * (sky_side + 2.0);
    return textureLod(sky_faces, texel / vec2(textureSize(sky_faces, 0)), 0.0).rgb;
}
#else
vec3 sky_color(vec3 direction) {
    float height = max(direction.z, 0.0);
    float curve = sky_zenith.a;
    vec3 sky = mix(sky_horizon.rgb, sky_zenith.rgb, height * (1.0 + curve) / (height + curve));
    sky += sky_glow.rgb * toward_sun(direction);
#ifdef LIT
    sky += sun_color.rgb * smoothstep(0.99985, 0.99995, dot(direction, to_sun.xyz));
#endif
    return sky;
}
#endif

void main() {
    vec3 direction = normalize(ray);
    float fall = -dot(direction, air_up.xyz);
    bool is_plane = sky_horizon.a > 0.0 && fall > 0.0;
    color = vec4(dithered(is_plane ? plane_color(direction, fall) : sky_color(direction)), 1.0);
}
