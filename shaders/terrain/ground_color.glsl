// Reflection of a terrain with surface detail, which fades out with distance.
uniform vec2 tile_sample;        // col, row of the terrain tile's first sample
uniform vec4 lit_from_sample;    // texture coordinate = sample · xy + zw
uniform vec4 ground_from_sample; // see lit_from_sample

layout(binding = ground_lit_map_unit) uniform sampler2D lit_map;    // reflected light, linear
#ifdef MESH_SHADOWS
#include "terrain/ground_sun.glsl"
layout(binding = ground_sun_map_unit) uniform sampler2D sun_map; // the sun's part; lit_map has the rest
#endif
layout(binding = albedo_map_unit) uniform sampler2D albedo_map; // linear
layout(binding = ground_map_unit) uniform sampler2D ground_map; // local normal; w: visible share of the sun

layout(location = 0) out vec4 color;

// The detail along one axis, tinted by the terrain. `right`, `up`: change of the tile coordinate per pixel.
// `height_share`: scales the heights of the search.
vec3 seen_in(mat3 space, vec3 albedo, vec2 right, vec2 up, float visibility, float height_share);

// The terrain's colour times the tile's deviation from its mean colour.
vec3 tinted(vec3 albedo, vec2 coordinate, vec2 right, vec2 up) {
    vec3 tile = textureLod(color_map, coordinate, level_of(color_map, right, up)).rgb;
    return min(albedo * tile / mean_color.rgb, vec3(1.0));
}

vec3 detailed(vec3 albedo, vec4 ground, vec3 across, vec3 down, float height_share) {
    vec3 normal = normalize(ground.xyz);
    vec3 shares = shares_of_axes(normal);
    int axis = max_faced_axis(shares);
    vec3 at = tiles_at_eye + from_eye / tile_width;
    tiles_per_metre = vec2(1.0 / tile_width);
    vec3 shown = vec3(0.0);
    for (int i = 0; i < 3; ++i, axis = (axis + 1) % 3) {
        if (shares[axis] > 0.0) {
            mat2x3 directions = directions_along(axis, normal);
            tile_coordinate = at * directions;
            vec2 right = across * directions / tile_width;
            vec2 up = down * directions / tile_width;
            mat3 space = space_along(directions, normal);
            shown += shares[axis] * seen_in(space, albedo, right, up, ground.w, height_share);
        }
    }
    return shown;
}

// Of the place per pixel, as columns.
mat2 change_of_place() {
#ifdef SLIVER
    return place_per_pixel;
#else
    return mat2(dFdx(FROM_PIXEL_TO_PIXEL(tile_place)), dFdy(FROM_PIXEL_TO_PIXEL(tile_place)));
#endif
}

vec4 looked_up(sampler2D map, vec4 map_from_sample) {
    vec2 place = tile_sample + INSIDE(tile_place);
    vec2 coordinate = place * map_from_sample.xy + map_from_sample.zw;
#if defined(SLIVER) || defined(MULTISAMPLED)
    mat2 change = change_of_place();
    return textureGrad(map, coordinate, change[0] * map_from_sample.xy, change[1] * map_from_sample.xy);
#else
    return texture(map, coordinate);
#endif
}

#if defined(MULTISAMPLED) && !defined(SLIVER)
float distance_to_eye() {
    return length(relative);
}
#elif !defined(SLIVER)
#include "frame/distance.glsl"
#endif

void main() {
#ifdef SLIVER
    set_from_corners();
#endif
    vec3 plain = looked_up(lit_map, lit_from_sample).rgb;
    vec3 albedo = looked_up(albedo_map, ground_from_sample).rgb;
    vec4 ground = looked_up(ground_map, ground_from_sample);
    from_eye = INSIDE(local_from_eye);
#ifdef SLIVER
    vec3 across = local_per_pixel[0];
    vec3 down = local_per_pixel[1];
#else
    vec3 across = dFdx(FROM_PIXEL_TO_PIXEL(local_from_eye));
    vec3 down = dFdy(FROM_PIXEL_TO_PIXEL(local_from_eye));
#endif
    relative = world_from_local * from_eye;
#ifdef MESH_SHADOWS
    ground.w = sun_on_triangles(tile_sample + INSIDE(tile_place), relative, change_of_place());
    plain += ground.w * looked_up(sun_map, lit_from_sample).rgb;
#endif
#ifdef POINT_LIGHTS
    plain += albedo * light_of_points(relative, normalize(world_from_normal * ground.xyz));
#endif
    float pixel = metres_a_pixel.x + metres_a_pixel.y * length(relative);
    float share = smoothstep(seen_pixels.x, seen_pixels.y, tile_width / pixel);
    float height_share = smoothstep(seen_pixels.z, seen_pixels.w, lift / pixel);
    vec3 shown = mix(plain, detailed(albedo, ground, across, down, height_share), share);
    keep_surface(albedo, normalize(world_from_normal * ground.xyz));
    color = vec4(seen_through_air(shaded(shown, relative), distance_to_eye()), 1.0);
}
