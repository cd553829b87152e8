// Computes: a coarse grid's light without its slopes and albedo: radiance over albedo, colour and a function of the normal,
// which is linear: the cosine to the sun, or 1 and a vector of the sky.
// Reads: normals, coarse_radiance, coarse_sun, coarse_albedo, all of the coarse grid.
// Writes: gathered, or gathered_scalar, where one value serves all colours.
// One invocation is one grid point.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;

// All colours are grey: images of one channel.
layout(constant_id = 0) const bool GREY = false;
// The sun's light is not part of this one.
layout(constant_id = 1) const bool WITHOUT_SUN = false;
layout(constant_id = 2) const bool ALBEDO_IS_MAP = false;
// Colours differ only by a factor, as under a sun alone.
layout(constant_id = 3) const bool IS_SCALAR = false;

layout(binding = 0) uniform texture2D normals;
layout(binding = 1) uniform texture2D coarse_radiance;
layout(binding = 2) uniform texture2D coarse_sun;
layout(binding = 3) uniform texture2D coarse_albedo;
layout(binding = 4, rgba32f) uniform writeonly image2D gathered;
layout(binding = 5, r32f) uniform writeonly image2D gathered_scalar;

layout(push_constant) uniform PreviewGatherPush {
    vec4 by_normal;     // east, north, up; and the constant
    vec4 most;      // what it is divided by besides; and the largest result
    vec4 colour;    // albedo where it is no map; and the least value of the function
    int cols;
    int rows;
};

// Albedo below which light is not divided by it.
const float DARK = 1e-3;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= cols || at.y >= rows) {
        return;
    }
    vec3 normal = texelFetch(normals, at, 0).xyz;
    vec3 light = GREY ? texelFetch(coarse_radiance, at, 0).xxx : texelFetch(coarse_radiance, at, 0).rgb;
    if (WITHOUT_SUN) {
        light -= GREY ? texelFetch(coarse_sun, at, 0).xxx : texelFetch(coarse_sun, at, 0).rgb;
    }
    vec3 albedo = ALBEDO_IS_MAP ? texelFetch(coarse_albedo, at, 0).rgb : colour.rgb;
    albedo = max(albedo, vec3(DARK));
    vec3 lit = albedo * most.rgb * max(by_normal.w + dot(normal, by_normal.xyz), colour.w);
    vec3 ratio = clamp(mix(light / lit, vec3(0.0), lessThanEqual(lit, vec3(0.0))), vec3(0.0), most.www);
    if (IS_SCALAR) {
        imageStore(gathered_scalar, at, vec4(max(ratio.r, max(ratio.g, ratio.b))));
    } else {
        imageStore(gathered, at, vec4(ratio, 1.0));
    }
}
