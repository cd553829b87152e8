// Computes: the depth of a picture with several samples a pixel: the first sample's.
// Reads: picture_depth.
// Writes: depth.
// One invocation is one pixel.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(binding = 0) uniform texture2DMS picture_depth;

void main() {
    gl_FragDepth = texelFetch(picture_depth, ivec2(gl_FragCoord.xy), 0).x;
}
