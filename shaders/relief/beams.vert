// One back-facing triangle over the whole picture.
void main() {
    vec2 place = vec2(gl_VertexID & 2, (gl_VertexID << 1) & 2);
    gl_Position = vec4(2.0 * place - 1.0, 0.0, 1.0);
}
