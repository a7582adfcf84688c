// The mean of 2 or 4 pictures.
#include "frame/bindings.inc"

layout(binding = picture_0_unit) uniform sampler2D picture_0; // linear
layout(binding = picture_1_unit) uniform sampler2D picture_1;
layout(binding = picture_2_unit) uniform sampler2D picture_2;
layout(binding = picture_3_unit) uniform sampler2D picture_3;
uniform int picture_count;

layout(location = 0) out vec4 color;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 sum = texelFetch(picture_0, pixel, 0).rgb + texelFetch(picture_1, pixel, 0).rgb;
    if (picture_count > 2) {
        sum += texelFetch(picture_2, pixel, 0).rgb + texelFetch(picture_3, pixel, 0).rgb;
    }
    color = vec4(sum / float(picture_count), 1.0);
}
