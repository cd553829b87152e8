// Computes: the displayed colour: radiance times exposure, a shoulder above 0.8, sRGB-encoded (IEC 61966-2-1): src/scene/tone.rs.
// Reads: radiance.
// Writes: picture.
// One invocation is one pixel.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

// Where the image format does not encode.
layout(constant_id = 0) const bool ENCODES = true;

const float SHOULDER = 0.8;
const float REST = 1.0 - SHOULDER;

layout(binding = 0) uniform texture2D radiance;

layout(push_constant) uniform PictureTonePush {
    float exposure;
};

layout(location = 0) out vec4 picture;

void main() {
    vec3 light = max(texelFetch(radiance, ivec2(gl_FragCoord.xy), 0).rgb * exposure, 0.0);
    vec3 shoulder = 1.0 - REST * REST / (max(light - SHOULDER, 0.0) + REST);
    light = mix(shoulder, light, lessThanEqual(light, vec3(SHOULDER)));
    if (ENCODES) {
        vec3 bright = 1.055 * pow(max(light, 1e-9), vec3(1.0 / 2.4)) - 0.055;
        light = mix(bright, 12.92 * light, lessThanEqual(light, vec3(0.0031308)));
    }
    picture = vec4(light, 1.0);
}
