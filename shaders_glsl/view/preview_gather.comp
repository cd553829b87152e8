// Computes: the light of a coarse grid without its slopes and albedo: radiance of everything but the sun over 1 + the
// cosine of the slope, and in the fourth channel the share of the sun that reaches the ground.
// Reads: heights, coarse_radiance, coarse_sun, coarse_albedo, all of the coarse grid.
// Writes: gathered.
// One invocation is one grid point.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;

// All colours are grey: images of one channel.
layout(constant_id = 0) const bool GREY = false;
layout(constant_id = 1) const bool HAS_SUN = false;
layout(constant_id = 2) const bool ALBEDO_IS_MAP = false;

layout(binding = 0) uniform texture2D heights;
layout(binding = 1) uniform texture2D coarse_radiance;
layout(binding = 2) uniform texture2D coarse_sun;
layout(binding = 3) uniform texture2D coarse_albedo;
layout(binding = 4, rgba32f) uniform writeonly image2D gathered;

layout(push_constant) uniform PreviewGatherPush {
    vec4 sun;       // direction east, north, up
    vec4 most;      // radiance of a white texel that faces the sun
    vec4 colour;    // albedo where it is no map
    vec2 cell_m;
    int cols;
    int rows;
};

#include "view/preview.glsl"

// The least cosine to the sun to divide by.
const float GRAZING = 1e-3;
// Albedo below which light is not divided by it.
const float DARK = 1e-3;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= cols || at.y >= rows) {
        return;
    }
    vec3 normal = normal_at(at, ivec2(cols, rows) - 1, cell_m);
    vec3 all = GREY ? texelFetch(coarse_radiance, at, 0).xxx : texelFetch(coarse_radiance, at, 0).rgb;
    vec3 of_sun = vec3(0.0);
    if (HAS_SUN) {
        of_sun = GREY ? texelFetch(coarse_sun, at, 0).xxx : texelFetch(coarse_sun, at, 0).rgb;
    }
    vec3 albedo = ALBEDO_IS_MAP ? texelFetch(coarse_albedo, at, 0).rgb : colour.rgb;
    albedo = max(albedo, vec3(DARK));
    float facing = max(dot(normal, sun.xyz), GRAZING);
    // of_sun = share * lit in every channel: the share follows from any channel where lit is not 0.
    vec3 lit = albedo * most.rgb * facing;
    vec3 shares = mix(of_sun / lit, vec3(0.0), lessThanEqual(lit, vec3(0.0)));
    float share = clamp(max(shares.r, max(shares.g, shares.b)), 0.0, 1.0);
    imageStore(gathered, at, vec4((all - of_sun) / (albedo * (1.0 + normal.z)), share));
}
