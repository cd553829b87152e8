// Computes: the radiance of a point of the plinth.
// Reads: voids.
// Writes: picture.
// One invocation is one pixel of one triangle; a wall has a gap where a grid point of its cell is void.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(constant_id = 1) const bool HAS_VOIDS = false;

// 0 where there is ground.
layout(binding = 2) uniform texture2D voids;

#define PLINTH
#include "view/ground.glsl"

layout(location = 0) flat in float light;
layout(location = 1) flat in int face;
layout(location = 2) centroid in float along;
layout(location = 0) out vec4 picture;

void main() {
    if (HAS_VOIDS && face < 4) {
        ivec2 last = ivec2(cols, rows) - 1;
        bool is_row = face % 2 == 0;
        int at = clamp(int(floor(along)), 0, (is_row ? last.x : last.y) - 1);
        ivec2 first = is_row ? ivec2(at, face == 0 ? 0 : last.y) : ivec2(face == 1 ? last.x : 0, at);
        ivec2 second = first + (is_row ? ivec2(1, 0) : ivec2(0, 1));
        if (texelFetch(voids, first, 0).x + texelFetch(voids, second, 0).x > 0.0) {
            discard;
        }
    }
    picture = vec4(vec3(light), 1.0);
}
