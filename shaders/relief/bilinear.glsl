// `corners`: as from textureGather. Graphics processors weigh by 8 bits when they filter.
float bilinear(vec4 corners, vec2 share) {
    vec2 sides = mix(corners.wz, corners.xy, share.y);
    return mix(sides.x, sides.y, share.x);
}
