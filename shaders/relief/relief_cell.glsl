// The part at which the ray crosses a cell's bilinear surface downwards; 2 if it does not. `corners`: as from
// textureGather; `enter`, `way`: of the ray in the cell, whose sides are 1; `above`: the ray enters above the
// surface, despite rounding.
float crossing(vec4 corners, vec3 enter, vec3 way, float begin, float end, inout bool above) {
    float h01 = corners.x;
    float h11 = corners.y;
    float h10 = corners.z;
    float h00 = corners.w;
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
