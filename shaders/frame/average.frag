// The mean of 2 or 4 pictures.
layout(binding = 0) uniform sampler2D pictures[4]; // linear

uniform int count;

layout(location = 0) out vec4 color;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 sum = texelFetch(pictures[0], pixel, 0).rgb + texelFetch(pictures[1], pixel, 0).rgb;
    if (count > 2) {
        sum += texelFetch(pictures[2], pixel, 0).rgb + texelFetch(pictures[3], pixel, 0).rgb;
    }
    color = vec4(sum / float(count), 1.0);
}
