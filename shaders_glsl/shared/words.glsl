// Two words in a texel of RGBA16UI: RG32UI needs the feature shaderStorageImageExtendedFormats.
uvec4 four_halves(uvec2 words) {
    return uvec4(words & 0xffffu, words >> 16).xzyw;
}

uvec2 two_words(uvec4 halves) {
    return halves.xz | halves.yw << 16;
}
