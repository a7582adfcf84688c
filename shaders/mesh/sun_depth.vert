// A mesh as the sun sees it (render::SunMap).
layout(location = 0) in vec3 position; // local metres

uniform mat4 sun_clip_from_local;

void main() {
    gl_Position = sun_clip_from_local * vec4(position, 1.0);
}
