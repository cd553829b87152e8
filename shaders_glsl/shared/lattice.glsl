#include "shared/lines.glsl"

// Result of a sweep: one value per line and step. 2^LAYER_SHIFT lines, 32 or more, are stored together, step after step, four
// lines per texel: a tile of 8 texels or more by `steps`, one layer of an image.
layout(constant_id = 40) const int LAYER_SHIFT = 5;

ivec3 lattice_texel(Azimuth azimuth, int line, int step) {
    int column = line & (1 << LAYER_SHIFT) - 1;
    return ivec3(column >> 2, step, int(azimuth.layer) + (line >> LAYER_SHIFT));
}

// Index, over all layers of the batch, of the group of four lines that contains `line`.
int lattice_four(Azimuth azimuth, int line) {
    return ((int(azimuth.layer) << LAYER_SHIFT) + line) >> 2;
}

// Value `line` & 3 of a texel of four.
uint lattice_value(uvec4 texel, int line) {
    uvec2 two = mix(texel.xy, texel.zw, bvec2((line & 2) != 0));
    return mix(two.x, two.y, (line & 1) != 0);
}
