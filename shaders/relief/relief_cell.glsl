// The part at which the ray crosses a cell's bilinear surface downwards; 2 if it does not. `above`: the ray
// enters above the surface, despite rounding.
float crossing(vec3 start, vec3 span, ivec2 cell, float begin, float end, inout bool above) {
    vec4 corners = textureGather(height_map, (vec2(cell) + 1.0) * height_texel);
    float h01 = corners.x;
    float h11 = corners.y;
    float h10 = corners.z;
    float h00 = corners.w;
    vec3 enter = start + begin * span - vec3(cell, 0.0);
    vec3 way = (end - begin) * span;
    float east = h10 - h00;
    float south = h01 - h00;
    float twist = h00 - h10 - h01 + h11;
    float c0 = enter.z - (h00 + enter.x * east + enter.y * south + enter.x * enter.y * twist);
    float c1 = way.z - (east * way.x + south * way.y +
                        twist * (enter.x * way.y + enter.y * way.x));
    float c2 = -twist * way.x * way.y;
    if (above && c0 < 0.0) {
        return begin; // crossed on the border
    }
    float root = 2.0;
    float under_root = c1 * c1 - 4.0 * c2 * c0;
    if (under_root >= 0.0) {
        float slope = sqrt(under_root);
        root = c1 < 0.0 ? 2.0 * c0 / (slope - c1) : (-c1 - slope) / (2.0 * c2);
    }
    above = c0 + c1 + c2 >= 0.0;
    return root >= 0.0 && root <= 1.0 ? begin + root * (end - begin) : 2.0;
}
