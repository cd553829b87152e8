// Two 32-bit words as four 16-bit channels of an RGBA16UI texel. RG32UI would need shaderStorageImageExtendedFormats.
uvec4 split_u32(uvec2 words) {
    return uvec4(words & 0xffffu, words >> 16).xzyw;
}

uvec2 join_u16(uvec4 parts) {
    return parts.xz | parts.yw << 16;
}
