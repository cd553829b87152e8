// Computes: exit radiance of a fine grid: light of a coarse grid, on the fine grid's own slopes and albedo.
// Reads: heights, albedo, gathered.
// Writes: radiance.
// One invocation is one grid point.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool HAS_SUN = false;
layout(constant_id = 1) const bool ALBEDO_IS_MAP = false;

layout(binding = 0) uniform texture2D heights;
layout(binding = 1) uniform texture2D albedo;
layout(binding = 2, rgba32f) uniform readonly image2D gathered;
layout(binding = 3, rgba32f) uniform writeonly image2D radiance;

layout(push_constant) uniform PreviewShadePush {
    vec4 sun;      // direction east, north, up
    vec4 most;     // radiance of a white texel that faces the sun
    vec4 colour;   // albedo where it is no map
    vec2 cell_m;
    int cols;
    int rows;
    int coarse_cols;
    int coarse_rows;
    float ratio;   // side of a fine cell over that of a coarse one
};

#include "view/preview.glsl"

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= cols || at.y >= rows) {
        return;
    }
    ivec2 last = ivec2(coarse_cols, coarse_rows) - 1;
    vec2 from = clamp((vec2(at) + 0.5) * ratio - 0.5, vec2(0.0), vec2(last));
    ivec2 a = ivec2(from);
    ivec2 d = min(a + 1, last);
    vec2 part = from - vec2(a);
    vec4 sky = mix(mix(imageLoad(gathered, a), imageLoad(gathered, ivec2(d.x, a.y)), part.x),
                   mix(imageLoad(gathered, ivec2(a.x, d.y)), imageLoad(gathered, d), part.x), part.y);
    vec3 normal = normal_at(at, ivec2(cols, rows) - 1, cell_m);
    vec3 light = sky.rgb * (1.0 + normal.z);
    if (HAS_SUN) {
        light += most.rgb * (sky.a * max(dot(normal, sun.xyz), 0.0));
    }
    light *= ALBEDO_IS_MAP ? texelFetch(albedo, at, 0).rgb : colour.rgb;
    imageStore(radiance, at, vec4(light, 1.0));
}
