// A visible place, as a material's own shader gets it (scene::SurfaceShader).
struct Surface {
    vec3 light;    // reflected towards the eye, before haze: linear
    vec3 albedo;   // linear
    vec3 normal;   // smooth: unit vector in the world
    vec3 from_eye; // world metres
    vec3 place;    // the same from the world's origin, which rounds it
};
