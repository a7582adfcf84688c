// Lighting of surface detail without a relief search.

// Height difference towards the sun (emboss bump mapping; Schlag 1994), as a share of the sun's light.
float embossed(vec2 place, float level, mat3 space) {
    vec3 to_light = normalize(local_from_relative * to_sun.xyz) * space;
    vec2 samples_per_metre = tiles_per_metre * tile_samples();
    float metres = max(emboss_delta, exp2(level)) / max(samples_per_metre.x, 1e-30);
    float below = seen_height(place + to_light.xy * metres * samples_per_metre, level);
    return (seen_height(place, level) - below) * lift / metres;
}

// `right`, `up`: change of the tile coordinate per pixel. `visibility`: visible share of the sun's disc.
vec3 lit_tile(vec3 albedo, vec2 coordinate, mat3 space, vec2 right, vec2 up, float visibility) {
    vec2 place = coordinate * tile_samples() - 0.5;
    vec3 upright = world_normal_of(vec3(0.0, 0.0, 1.0), space);
#if defined(NORMAL_MAP)
    float level = level_of(normal_map, right, up);
    vec3 normal = world_normal_of(mapped_normal(coordinate, level), space);
    return shiny_color(albedo, normal, upright, normalize(way_to_eye()), visibility);
#elif defined(BUMP)
    float level = max(level_of(height_map, right, up), 0.0);
    vec3 normal = world_normal_of(bumped_normal(place, level), space);
    return shiny_color(albedo, normal, upright, normalize(way_to_eye()), visibility);
#elif defined(EMBOSS)
    float facing = facing_of(upright) * visibility;
    float level = max(level_of(height_map, right, up), 0.0);
    float sun = max(dot(upright, to_sun.xyz) + embossed(place, level, space), 0.0) * facing;
    return with_points(albedo * (sun_color.rgb * sun + ambient_color.rgb * (0.5 + 0.5 * upright.z)), albedo, upright);
#else
    return with_points(lit_color(albedo, upright, visibility), albedo, upright);
#endif
}
