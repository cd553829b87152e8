// Computes: a triangle that covers the picture.
// Reads: nothing.
// Writes: position only.
// One invocation is one corner of it.
#version 460

void main() {
    gl_Position = vec4(vec2(float((gl_VertexIndex & 1) * 4), float((gl_VertexIndex & 2) * 2)) - 1.0, 0.0, 1.0);
}
