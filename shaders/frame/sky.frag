#include "frame/frame_block.glsl"

in vec3 ray;

layout(location = 0) out vec4 color;

void main() {
    vec3 direction = normalize(ray);
    float height = direction.z;
    vec3 sky = height > 0.0 ? mix(sky_horizon.rgb, sky_zenith.rgb, sqrt(height))
                            : sky_horizon.rgb * (1.0 + 0.35 * max(height, -1.0));
#ifdef LIT
    // Forward scattering: a wide glow around the disc.
    float toward = max(dot(direction, to_sun.xyz), 0.0);
    float glow = toward * toward;
    glow *= glow;
    glow *= glow;
    sky += sun_color.rgb * (0.18 * glow + smoothstep(0.99985, 0.99995, toward));
#endif
    color = vec4(sky, 1.0);
}
