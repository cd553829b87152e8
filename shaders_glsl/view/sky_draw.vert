// Computes: a triangle that covers the picture, at infinity.
// Reads: nothing.
// Writes: position in the picture, -1 to 1 from left to right and from top to bottom.
// One invocation is one corner of it.
#version 460

layout(location = 0) out vec2 at;

void main() {
    at = vec2(float((gl_VertexIndex & 1) * 4), float((gl_VertexIndex & 2) * 2)) - 1.0;
    gl_Position = vec4(at, 0.0, 1.0);
}
