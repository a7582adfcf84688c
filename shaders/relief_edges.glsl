// The place that a ray narrowly misses on its way to its hit (GPU surface-detail survey 2008 ch.
// 3.6.7): where the same search, so much lower, meets the surface, and then where the ray is nearest.
uniform float edge_distance; // of the range of heights

// How far the ray is from the surface there, over edge_distance, and the place; 1 where it misses
// nothing on its way to `part`.
float near_miss(vec3 start, vec3 span, float part, out vec2 place) {
    const float most_steps = 64.0;
    vec3 lowered = start - vec3(0.0, 0.0, edge_distance);
    float at;
    bool near = find_hit(lowered, part * span, at, place);
    float nearest = 1.0;
    if (near) {
        // On from there, a sample at a time, as long as the surface comes nearer.
        vec3 way = part * span;
        float samples = max(abs(way.x), abs(way.y));
        float stride = max(1.0 / max(samples, 1.0), (1.0 - at) / most_steps);
        float distance = edge_distance;
        bool nearing = true;
        while (nearing && at < 1.0) {
            at += stride;
            vec3 p = start + min(at, 1.0) * way;
            float now = p.z - height_at(p.xy);
            nearing = now <= distance;
            distance = nearing ? now : distance;
            place = nearing ? p.xy : place;
        }
        nearest = nearing ? 1.0 : clamp(distance / edge_distance, 0.0, 1.0);
    }
    return nearest;
}
