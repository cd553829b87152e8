// Computes: indirect light at every grid point: the ground's share of its own hemisphere, times the mean radiance of
// the ground visible from the nodes around it.
// Reads: ground (height, slopes towards east and north), sky_share, node_sum.
// Writes: bounce_sum (exit radiance for albedo 1).
// One invocation is one grid point.
#version 460

layout(local_size_x = 8, local_size_y = 8) in;

// Grid points from node to node: 2, 4 or 8.
layout(constant_id = 0) const int NODE_STRIDE = 2;

layout(binding = 0, rgba32f) uniform readonly image2D ground;
// Exit radiance under a sky of radiance 1; the rest of the hemisphere is ground.
layout(binding = 1, r32f) uniform readonly image2D sky_share;
layout(binding = 2, rgba32f) uniform readonly image2D node_sum;
layout(binding = 3, rgba32f) uniform writeonly image2D bounce_sum;

layout(push_constant) uniform BounceShadePush {
    int cols;
    int rows;
    float cell_x_m;
    float cell_y_m;
};

#include "shared/nodes.glsl"
#include "sh/alike.glsl"

// Least divisor where a texel's share is larger than the nodes': below it, theirs may be numerical noise.
const float LEAST_SHARE = 1.0 / 256.0;

float ground_share(ivec2 at) {
    return max(1.0 - imageLoad(sky_share, at).x, 0.0);
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= cols || at.y >= rows) {
        return;
    }
    ivec2 last = ivec2(node_count(cols, NODE_STRIDE), node_count(rows, NODE_STRIDE)) - 1;
    ivec2 low = at / NODE_STRIDE;
    ivec2 high = min(low + 1, last);
    ivec2 from = ivec2(node_place(low.x, cols, NODE_STRIDE), node_place(low.y, rows, NODE_STRIDE));
    ivec2 to = ivec2(node_place(high.x, cols, NODE_STRIDE), node_place(high.y, rows, NODE_STRIDE));
    vec2 way = vec2(at - from) / vec2(max(to - from, 1));
    // The nodes, low and high along both axes.
    ivec2 places[4] = ivec2[4](from, ivec2(to.x, from.y), ivec2(from.x, to.y), to);
    ivec2 nodes[4] = ivec2[4](low, ivec2(high.x, low.y), ivec2(low.x, high.y), high);
    vec4 h;
    vec4 east;
    vec4 north;
    vec4 shares;
    for (int i = 0; i < 4; i++) {
        vec4 node = imageLoad(ground, places[i]);
        h[i] = node.x;
        east[i] = node.y;
        north[i] = node.z;
        shares[i] = ground_share(places[i]);
    }
    // Distance at which their ground is visible.
    vec2 from_m = vec2(at - from) * vec2(cell_x_m, -cell_y_m);
    vec2 to_m = vec2(at - to) * vec2(cell_x_m, -cell_y_m);
    vec4 east_m = vec4(from_m.x, to_m.x, from_m.x, to_m.x);
    vec4 north_m = vec4(from_m.yy, to_m.yy);
    vec2 back = 1.0 - way;
    vec4 near = vec4(back.x, way.x, back.x, way.x) * vec4(back.yy, way.yy);
    vec4 counts = near * alike(imageLoad(ground, at), h, east, north, east_m, north_m, min(cell_x_m, cell_y_m));
    vec3 light = vec3(0.0);
    for (int i = 0; i < 4; i++) {
        light += counts[i] * imageLoad(node_sum, nodes[i]).rgb;
    }
    // A node keeps its own light. A texel without visible ground, among nodes with some, gets none.
    float weight = max(counts.x + counts.y + counts.z + counts.w, 1e-30);
    float around = dot(counts, shares) / weight;
    float share = ground_share(at);
    float more = 1.0 + (share - around) / max(around, LEAST_SHARE);
    float ratio = share >= around ? more : share / around;
    imageStore(bounce_sum, at, vec4(light / weight * ratio, 1.0));
}
