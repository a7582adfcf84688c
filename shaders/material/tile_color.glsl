float sun_beside_others = 1.0; // the part of the sun that reaches the mesh

// Reflection of a place of the tile towards the eye. `way`: to the eye. `right`, `up`: change of the tile
// coordinate per pixel.
vec3 color_at(vec2 place, mat3 space, vec3 way, vec2 right, vec2 up) {
    vec2 coordinate = (place + 0.5) * height_texel;
    vec3 albedo = textureLod(color_map, coordinate, level_of(color_map, right, up)).rgb;
    vec3 leaning = mapped_normal(coordinate, level_of(normal_map, right, up));
    vec3 normal = world_normal_of(leaning, space);
#ifdef LAYERS
    vec3 upright = normal; // the back is lit, too
#else
    vec3 upright = world_normal_of(vec3(0.0, 0.0, 1.0), space);
#endif
    float sun = sun_beside_others > 0.0 ? sun_beside_others * sun_share(place, space, right, up) : 0.0;
    return shiny_color(albedo, normal, upright, normalize(way), sun);
}
