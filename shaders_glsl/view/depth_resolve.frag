// Computes: the depth of sample 0 of each pixel of an MSAA picture.
// Reads: picture_depth.
// Writes: depth.
// One invocation is one pixel.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(binding = 0) uniform texture2DMS picture_depth;

void main() {
    gl_FragDepth = texelFetch(picture_depth, ivec2(gl_FragCoord.xy), 0).x;
}
