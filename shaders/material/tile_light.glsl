// Per-pixel lighting of surface detail.
layout(binding = color_map_unit) uniform sampler2D color_map;  // linear albedo
#ifdef LAYERS
layout(binding = normal_map_unit) uniform sampler2D normal_map;   // x of the layers' normals in tangent space
layout(binding = normal_map_v_unit) uniform sampler2D normal_map_v; // y
#else
layout(binding = normal_map_unit) uniform sampler2D normal_map; // x and y of the normal in tangent space
#endif

uniform mat3 world_from_normal;
#ifdef POINT_LIGHTS
#include "material/point_lights.glsl"
#endif

// Mip level; `right`, `up`: change of the coordinate per pixel. Limited to an anisotropy of 8.
float level_of(sampler2D map, vec2 right, vec2 up) {
    vec2 texels = vec2(textureSize(map, 0));
    float across = dot(right * texels, right * texels);
    float down = dot(up * texels, up * texels);
    return 0.5 * log2(min(max(across, down), 64.0 * max(min(across, down), 1e-12)));
}

// Normal of a surface with that slope (Blinn 1978, in an orthonormal frame).
vec3 normal_of_slope(vec2 slope) {
    return normalize(vec3(-slope, 1.0));
}

// From the map, rescaled to the actual height.
vec3 mapped_normal(vec2 coordinate, float level) {
#ifdef LAYERS
    vec2 lean = vec2(textureLod(normal_map, coordinate, level)[hit_layer],
                     textureLod(normal_map_v, coordinate, level)[hit_layer]);
#else
    vec2 lean = side * textureLod(normal_map, coordinate, level).rg;
#endif
    float upright = sqrt(max(1.0 - dot(lean, lean), 1e-4));
    vec3 normal = normal_of_slope(-lean / upright * tiles_per_metre * (lift / normal_scale));
    return vec3(normal.xy, outward() * normal.z);
}

float seen_height(vec2 place, float level) {
    return textureLod(height_map, (place + 0.5) * height_texel, level).r;
}

// From the heights half a texel around. From afar from the normal map: averaged heights do not have the
// mean normal.
vec3 bumped_normal(vec2 place, float level) {
    const vec2 right = vec2(0.5, 0.0);
    const vec2 up = vec2(0.0, 0.5);
    vec2 rise = vec2(seen_height(place + right, 0.0) - seen_height(place - right, 0.0),
                     seen_height(place + up, 0.0) - seen_height(place - up, 0.0));
    vec3 near = normal_of_slope(rise * lift * tiles_per_metre * tile_samples());
    vec3 far = mapped_normal((place + 0.5) * height_texel, level);
    return normalize(mix(near, far, clamp(level, 0.0, 1.0)));
}

vec3 world_normal_of(vec3 tangent_normal, mat3 space) {
    return normalize(world_from_normal * (space * tangent_normal));
}

// Nothing on a mesh that faces away from the sun is lit. Fades over a few degrees; over one degree on a
// terrain, whose own light does not fade.
float facing_of(vec3 upright) {
#ifdef GROUND
    const float steepness = 64.0;
#else
    const float steepness = 8.0;
#endif
    return clamp(steepness * dot(upright, to_sun.xyz), 0.0, 1.0);
}

// Adds the light of points, at the place on the mesh, not in its relief.
vec3 with_points(vec3 lit, vec3 albedo, vec3 normal) {
    keep_surface(albedo, normal);
#ifdef POINT_LIGHTS
    return lit + albedo * light_of_points(relative, normal);
#else
    return lit;
#endif
}

// `upright`: the mesh's normal. `visibility`: visible share of the sun's disc.
vec3 shiny_color(vec3 albedo, vec3 normal, vec3 upright, vec3 to_eye, float visibility) {
#ifdef LIT
    float facing = facing_of(upright) * visibility;
    float sun = max(dot(normal, to_sun.xyz), 0.0) * facing;
    float sky = 0.5 + 0.5 * normal.z;
    float mirrored = max(dot(normal, normalize(to_sun.xyz + to_eye)), 0.0);
    float added = sun > 0.0 ? shine.x * facing * pow(mirrored, shine.y) : 0.0;
    vec3 lit = albedo * (sun_color.rgb * sun + ambient_color.rgb * sky) + sun_color.rgb * added;
#else
    vec3 lit = albedo;
#endif
    return with_points(lit, albedo, normal);
}
