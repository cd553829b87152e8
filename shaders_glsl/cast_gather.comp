// Computes: what every node sees of one more bounce: the radiance of each stretch of its casting sets, which the
// first bounce has left, times its weight.
// Reads: casting_sets, exit_radiance (or exit_grey). Reads and writes: bounce_sum (exit radiance for albedo 1; in A what
// whole hemispheres would give, which divides it, and stays).
// One invocation is one node.
#version 460
#extension GL_KHR_shader_subgroup_vote : require

layout(local_size_x = 8, local_size_y = 8) in;

// Azimuths, and stretches that are kept of each.
layout(constant_id = 0) const int AZIMUTHS = 32;
layout(constant_id = 1) const int CAST_SLOTS = 8;
// Radiance of one channel.
layout(constant_id = 2) const bool GREY = false;

layout(binding = 0, rg32ui) uniform readonly uimage2DArray casting_sets;
layout(binding = 1, rgba32f) uniform readonly image2D exit_radiance;
layout(binding = 2, r32f) uniform readonly image2D exit_grey;
layout(binding = 3, rgba32f) uniform image2D bounce_sum;

layout(push_constant) uniform CastGatherPush {
    int nodes_x;
    int nodes_y;
};

#include "shared/casting_set.glsl"

vec3 leaving(ivec2 at) {
    vec3 colour;
    if (GREY) {
        colour = imageLoad(exit_grey, at).xxx;
    } else {
        colour = imageLoad(exit_radiance, at).rgb;
    }
    return colour;
}

void main() {
    ivec2 node = ivec2(gl_GlobalInvocationID.xy);
    if (node.x >= nodes_x || node.y >= nodes_y) {
        return;
    }
    vec3 thrown = vec3(0.0);
    for (int k = 0; k < AZIMUTHS; k++) {
        bool on = true;
        for (int slot = 0; slot < CAST_SLOTS; slot++) {
            uvec2 kept = imageLoad(casting_sets, ivec3(node, k * CAST_SLOTS + slot)).xy;
            on = on && kept.x != CASTS_END;
            // Left by all lanes together, as in horizon_sweep.
            if (!subgroupAny(on)) {
                break;
            }
            vec3 light = leaving(mix(ivec2(0), cast_place(kept), bvec2(on)));
            thrown += mix(0.0, uintBitsToFloat(kept.y), on) * light;
        }
    }
    float whole = imageLoad(bounce_sum, node).a;
    imageStore(bounce_sum, node, vec4(thrown / max(whole, 1e-30), whole));
}
