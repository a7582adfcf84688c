// What a tile of detail sends to the eye, lit per pixel.
layout(binding = 0) uniform sampler2D color_map;  // linear albedo
#ifdef LAYERS
layout(binding = 4) uniform sampler2D normal_map;   // x of the layers' normals in tangent space
layout(binding = 5) uniform sampler2D normal_map_v; // y
#else
layout(binding = 4) uniform sampler2D normal_map; // x and y of the normal in tangent space
#endif

uniform mat3 world_from_normal;
uniform float normal_scale; // relief scale that the normal map was made for
uniform vec2 shine;         // what a mirror adds; exponent (Blinn 1977)

// The mip level for a pixel that moves over the map so far from pixel to pixel; no coarser than
// for a surface that is seen eight times longer than wide.
float level_of(sampler2D map, vec2 right, vec2 up) {
    vec2 texels = vec2(textureSize(map, 0));
    float across = dot(right * texels, right * texels);
    float down = dot(up * texels, up * texels);
    return 0.5 * log2(min(max(across, down), 64.0 * max(min(across, down), 1e-12)));
}

// Off a surface that rises so far a metre in x and y (Blinn 1978, for a frame that is orthonormal).
vec3 normal_of_slope(vec2 slope) {
    return normalize(vec3(-slope, 1.0));
}

// From the map; what is higher than the map was made for leans more.
vec3 mapped_normal(vec2 coordinate, float level) {
#ifdef LAYERS
    vec2 lean = vec2(textureLod(normal_map, coordinate, level)[met_layer],
                     textureLod(normal_map_v, coordinate, level)[met_layer]);
#else
    vec2 lean = side * textureLod(normal_map, coordinate, level).rg;
#endif
    float upright = sqrt(max(1.0 - dot(lean, lean), 1e-4));
    vec3 normal = normal_of_slope(-lean / upright * tiles_per_metre * (lift / normal_scale));
    return vec3(normal.xy, outward() * normal.z);
}

// Of the heights as they are seen from afar.
float seen_height(vec2 place, float level) {
    return textureLod(height_map, (place + 0.5) * height_texel, level).r;
}

// What heights a texel of a level around a place rise by in x and y, a texel of level 0.
vec2 rise_around(vec2 place, float texels, float level) {
    vec2 right = vec2(0.5 * texels, 0.0);
    vec2 up = vec2(0.0, 0.5 * texels);
    return vec2(seen_height(place + right, level) - seen_height(place - right, level),
                seen_height(place + up, level) - seen_height(place - up, level)) / texels;
}

// The mean of the normals that the heights have on what a pixel covers, as a normal map's levels
// hold it: of the mean slope a steep edge would make the more, the farther it is.
vec3 bumped_normal(vec2 place, float level) {
    vec2 lift_per_texel = lift * tiles_per_metre * tile_samples();
    float parts = level > 0.0 ? 4.0 : 1.0; // of the pixel, along each side
    float texels = exp2(level) / parts;
    float fine = max(level - log2(parts), 0.0);
    vec3 sum = vec3(0.0);
    for (float i = 0.0; i < parts * parts; ++i) {
        vec2 part = vec2(mod(i, parts), floor(i / parts)) + 0.5 - 0.5 * parts;
        sum += normal_of_slope(rise_around(place + part * texels, texels, fine) * lift_per_texel);
    }
    return normalize(sum);
}

vec3 world_normal_of(vec3 tangent_normal, mat3 space) {
    return normalize(world_from_normal * (space * tangent_normal));
}

// `upright`: the mesh's own normal; where that looks away from the sun, nothing on it is lit.
// `visibility`: share of the sun's disc that is seen.
vec3 shiny_color(vec3 albedo, vec3 normal, vec3 upright, vec3 to_eye, float visibility) {
#ifdef LIT
    float facing = clamp(8.0 * dot(upright, to_sun.xyz), 0.0, 1.0) * visibility;
    float sun = max(dot(normal, to_sun.xyz), 0.0) * facing;
    float sky = 0.5 + 0.5 * normal.z;
    float mirrored = max(dot(normal, normalize(to_sun.xyz + to_eye)), 0.0);
    float added = sun > 0.0 ? shine.x * facing * pow(mirrored, shine.y) : 0.0;
    return albedo * (sun_color.rgb * sun + ambient_color.rgb * sky) + sun_color.rgb * added;
#else
    return albedo;
#endif
}
