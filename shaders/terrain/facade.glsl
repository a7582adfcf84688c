// Walls of buildings (view::FacadeMap), as packets of rays paint them.
layout(binding = facade_samples_unit) uniform sampler2D facade_samples; // x: 1 + wall; y: height of the shadow
layout(binding = facade_walls_unit) uniform sampler2D facade_walls;     // view::FacadeTexels

vec4 wall_texel(int wall, int index) {
    int walls_a_row = textureSize(facade_walls, 0).x / 4;
    return texelFetch(facade_walls, ivec2(wall % walls_a_row * 4 + index, wall / walls_a_row), 0);
}

// The integral of the periodic stripes from `begin` to `end`, parts of a period.
float stripes_until(float x, float begin, float end) {
    float whole = floor(x);
    return whole * (end - begin) + clamp(x - whole - begin, 0.0, end - begin);
}

// The share of stripes in a pixel. `along`: its middle and its width, periods.
float share_of_stripes(vec2 along, float begin, float end) {
    float half_width = 0.5 * along.y;
    return (stripes_until(along.x + half_width, begin, end) -
            stripes_until(along.x - half_width, begin, end)) / along.y;
}

vec3 wall_albedo(vec2 u, vec2 v, vec3 plaster) {
    float frames = share_of_stripes(u, frame_begin, frame_end) * share_of_stripes(v, frame_top, frame_bottom);
    float panes = (share_of_stripes(u, left_pane_begin, left_pane_end) +
                   share_of_stripes(u, right_pane_begin, right_pane_end)) *
                  share_of_stripes(v, pane_top, pane_bottom);
    float ledges = share_of_stripes(u, sill_begin, sill_end) * share_of_stripes(v, sill_top, sill_bottom) +
                   share_of_stripes(v, 0.0, ledge_bottom);
    return plaster * (1.0 - frames - (1.0 - ledge_light) * ledges) +
           vec3(frame_red, frame_green, frame_blue) * (frames - panes) +
           vec3(pane_red, pane_green, pane_blue) * panes;
}

// Of a pixel on a wall, in periods. `of_view`: the view direction's part along it.
float width_on_wall(float pixel, float of_view, float facing, float periods_a_metre) {
    float longer = of_view / facing;
    return max(pixel * sqrt(1.0 + longer * longer) * periods_a_metre, narrowest_pixel);
}

bool faces_as_wall(vec3 normal, vec2 outward) {
    float min_leaning = normal.z < upright_cosine ? corner_leaning : wall_leaning;
    return dot(outward, normal.xy) > min_leaning * length(normal.xy);
}

// The colour of ground with façades. `at`: sample; `height`: true metres.
vec3 with_facades(vec3 lit, GroundPlace place, vec2 at, float height) {
    float exaggeration = contours.y;
    vec3 normal = normalize(vec3(place.normal.xy, place.normal.z * exaggeration)); // of true heights
    if (normal.z >= wall_cosine) {
        return lit;
    }
    vec2 near = texelFetch(facade_samples, ivec2(round(at)), 0).xy;
    int wall = int(near.x) - 1;
    if (wall < 0) {
        return lit;
    }
    vec4 along = wall_texel(wall, 0);
    vec4 storeys = wall_texel(wall, 1);
    vec4 outward = wall_texel(wall, 2);
    vec4 plaster = wall_texel(wall, 3);
    bool is_high = height > storeys.y;
    if (!faces_as_wall(normal, outward.xy) || height > outward.w) {
        return lit;
    }
    float facing = max(abs(dot(outward.xy, place.view.xy)), flattest_facing);
    float across = outward.x * place.view.y - outward.y * place.view.x;
    vec2 u = vec2(dot(at - along.xy, along.zw) + storeys.x,
                  width_on_wall(place.pixel, across, facing, 1.0 / storeys.w));
    vec2 v = vec2((storeys.y - height) * storeys.z,
                  width_on_wall(place.pixel, place.view.z, facing, storeys.z / exaggeration));
    vec3 albedo = is_high ? plaster.rgb : wall_albedo(u, v, plaster.rgb);
    float risen = (height - plaster.w) / max(storeys.y - plaster.w, 1.0);
    float sky = mix(sky_at_foot, 1.0, clamp(risen, 0.0, 1.0));
    float sun = outward.z * clamp((height - near.y) / shadow_border, 0.0, 1.0);
    vec3 light = facade_sun.rgb * sun + facade_sky.rgb * sky;
#ifdef POINT_LIGHTS
    light += light_of_points(along_world_axes(place.from_eye), along_world_axes(vec3(outward.xy, 0.0)));
#endif
    return albedo * light;
}
