// The shadow of ground (render::GroundShadow), true heights. x: below it ground hides the sun; y: of the ground.
layout(binding = ground_shadow_unit) uniform sampler2D ground_shadow;

// The part of the sun at a height above the border of the shadow, which is a pixel wide. `change`: of the height per
// pixel.
float sun_above(float height, float change) {
    const float min_change = 1e-6; // metres: level shadows have a sharp border
    return clamp(height / max(change, min_change) + 0.5, 0.0, 1.0);
}
