// Computes: the background behind the field: a uniform sky and an environment, by direction.
// Reads: environment.
// Writes: picture.
// One invocation is one pixel.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(constant_id = 0) const bool HAS_ENVIRONMENT = false;

layout(binding = 0) uniform texture2D environment;

layout(push_constant) uniform SkyDrawPush {
    vec4 forward;
    vec4 right;  // to the picture's right edge
    vec4 down;   // to its lower edge
    vec4 above;  // radiance of directions above horizontal, without the environment's
    vec4 below;  // of others
    float rotation_turns;
};

layout(location = 0) in vec2 at;
layout(location = 0) out vec4 picture;

const float PI = 3.14159265358979;

// Texel (col, row) covers azimuths pi - 2 pi [col, col + 1] / width and zenith angles pi [row, row + 1] / height;
// radiance is bilinear between texel centres.
vec3 environment_towards(vec3 e) {
    ivec2 size = textureSize(environment, 0);
    // atan(0, 0) is undefined in GLSL. Straight up or down, any azimuth is right.
    bool has_azimuth = e.x != 0.0 || e.y != 0.0;
    float turn = fract(0.5 - atan(e.y, has_azimuth ? e.x : 1.0) / (2.0 * PI) + rotation_turns);
    float down = atan(length(e.xy), e.z) / PI;
    vec2 place = vec2(turn, down) * vec2(size) - 0.5;
    vec2 whole = floor(place);
    vec2 share = place - whole;
    ivec2 at = ivec2(whole);
    int west = (at.x + size.x) % size.x;
    int east = (at.x + 1) % size.x;
    int north = clamp(at.y, 0, size.y - 1);
    int south = clamp(at.y + 1, 0, size.y - 1);
    vec3 upper = mix(texelFetch(environment, ivec2(west, north), 0).rgb,
                     texelFetch(environment, ivec2(east, north), 0).rgb, share.x);
    vec3 lower = mix(texelFetch(environment, ivec2(west, south), 0).rgb,
                     texelFetch(environment, ivec2(east, south), 0).rgb, share.x);
    return mix(upper, lower, share.y);
}

void main() {
    vec3 e = forward.xyz + at.x * right.xyz + at.y * down.xyz;
    vec3 colour = mix(below.rgb, above.rgb, float(e.z > 0.0));
    if (HAS_ENVIRONMENT) {
        colour += environment_towards(e);
    }
    picture = vec4(colour, 1.0);
}
