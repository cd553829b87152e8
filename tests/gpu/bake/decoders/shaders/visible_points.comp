// Computes: what the decoder that `bake` writes beside a map makes of it.
// Reads: visible_points.ktx2.
// Writes: values, a plane each: rows and columns; last, how much of a light between the first three directions arrives.
// One invocation is a texel and a plane.
#version 460

layout(local_size_x = 64) in;

layout(binding = 0) uniform sampler2DArray map;
layout(std430, binding = 1) writeonly buffer Values {
    float values[];
};
layout(push_constant) uniform Push {
    int cols;
    int rows;
    float offset;
};

#include "decode/visible_points.glsl"

void main() {
    int i = int(gl_GlobalInvocationID.x);
    int plane = int(gl_GlobalInvocationID.z);
    if (i >= cols * rows) {
        return;
    }
    vec2 uv = (vec2(i % cols, i / cols) + 0.5) / vec2(cols, rows);
    bool is_share = plane == 2 * textureSize(map, 0).z;
    float point = is_share ? 0.0 : float(visible_point(map, uv, plane / 2)[1 - plane % 2]);
    values[plane * cols * rows + i] = is_share ? visible_share(map, uv, ivec3(0, 1, 2), vec3(0.5, 0.3, 0.2)) : point;
}
