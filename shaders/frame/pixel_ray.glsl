// In perspective, the view ray through this pixel or sample, at depth 1; relative to the eye.
vec3 pixel_ray() {
    vec2 place = gl_FragCoord.xy * pixel_share.xy;
    return ray_corner.xyz + place.x * ray_right.xyz + place.y * ray_up.xyz;
}
