// Computes: the displayed colour: radiance times exposure, clipped to 0..1, sRGB-encoded (IEC 61966-2-1).
// Reads: radiance.
// Writes: picture.
// One invocation is one pixel.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

// Where the image format does not encode.
layout(constant_id = 0) const bool ENCODES = true;

layout(binding = 0) uniform texture2D radiance;

layout(push_constant) uniform PictureTonePush {
    float exposure;
};

layout(location = 0) out vec4 picture;

void main() {
    vec3 light = clamp(texelFetch(radiance, ivec2(gl_FragCoord.xy), 0).rgb * exposure, 0.0, 1.0);
    if (ENCODES) {
        vec3 bright = 1.055 * pow(max(light, 1e-9), vec3(1.0 / 2.4)) - 0.055;
        light = mix(bright, 12.92 * light, lessThanEqual(light, vec3(0.0031308)));
    }
    picture = vec4(light, 1.0);
}
