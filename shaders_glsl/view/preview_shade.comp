// Computes: exit radiance of a fine grid: light of coarser grids, on the fine grid's own slopes and albedo.
// Reads: normals (means over what a texel covers), albedo, sky, sun: what `preview_gather` writes.
// Writes: radiance.
// One invocation is one grid point.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool HAS_SUN = false;
layout(constant_id = 1) const bool ALBEDO_IS_MAP = false;

layout(binding = 0) uniform texture2D normals;
layout(binding = 1) uniform texture2D albedo;
layout(binding = 2, rgba32f) uniform readonly image2D sky;
layout(binding = 3, r32f) uniform readonly image2D sun;
layout(binding = 4, rgba32f) uniform writeonly image2D radiance;

layout(push_constant) uniform PreviewShadePush {
    vec4 sky_by_normal;    // as in `preview_gather`
    vec4 sun_by_normal;
    vec4 most;         // radiance of a white texel that faces the sun
    vec4 colour;       // albedo where it is no map; and the least value of the sky's function
    int cols;
    int rows;
    int sky_cols;
    int sky_rows;
    int sun_cols;
    int sun_rows;
    float sky_ratio;   // side of a fine cell over that of a coarse one
    float sun_ratio;
};

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= cols || at.y >= rows) {
        return;
    }
    vec3 normal = texelFetch(normals, at, 0).xyz;
    ivec2 last = ivec2(sky_cols, sky_rows) - 1;
    vec2 from = clamp((vec2(at) + 0.5) * sky_ratio - 0.5, vec2(0.0), vec2(last));
    ivec2 a = ivec2(from);
    ivec2 d = min(a + 1, last);
    vec2 part = from - vec2(a);
    vec3 north = mix(imageLoad(sky, a).rgb, imageLoad(sky, ivec2(d.x, a.y)).rgb, part.x);
    vec3 south = mix(imageLoad(sky, ivec2(a.x, d.y)).rgb, imageLoad(sky, d).rgb, part.x);
    vec3 light = mix(north, south, part.y) * max(sky_by_normal.w + dot(normal, sky_by_normal.xyz), colour.w);
    if (HAS_SUN) {
        last = ivec2(sun_cols, sun_rows) - 1;
        from = clamp((vec2(at) + 0.5) * sun_ratio - 0.5, vec2(0.0), vec2(last));
        a = ivec2(from);
        d = min(a + 1, last);
        part = from - vec2(a);
        float upper = mix(imageLoad(sun, a).r, imageLoad(sun, ivec2(d.x, a.y)).r, part.x);
        float lower = mix(imageLoad(sun, ivec2(a.x, d.y)).r, imageLoad(sun, d).r, part.x);
        light += mix(upper, lower, part.y) * most.rgb * max(dot(normal, sun_by_normal.xyz), 0.0);
    }
    light *= ALBEDO_IS_MAP ? texelFetch(albedo, at, 0).rgb : colour.rgb;
    imageStore(radiance, at, vec4(light, 1.0));
}
