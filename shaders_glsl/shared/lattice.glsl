#include "shared/sweep.glsl"

// Result of a sweep: one value per line and step. 32 lines are stored together, step after step, four lines per
// texel: a tile of 8 texels by `steps`, one layer of an image. A group of lines writes one contiguous range of memory
// in any azimuth.

// Lines before lane 0 at step 0 that the shear brings onto the field later.
int lattice_lead(int shear, int total_steps, int line_shift, bool periodic) {
    return periodic ? 0 : ((total_steps - 1) * shear + (1 << line_shift) - 1) >> line_shift;
}

int lattice_lines(int lanes, int lead, int line_shift, bool periodic) {
    return periodic ? (lanes * CELL) >> line_shift : (((lanes - 1) * CELL) >> line_shift) + 1 + lead;
}

ivec3 lattice_texel(Azimuth azimuth, int line, int step) {
    return ivec3((line & 31) >> 2, step, int(azimuth.layer) + (line >> 5));
}

// Halfword `line` & 3 of a texel of four.
uint lattice_u16(uvec2 texel, int line) {
    uint word = mix(texel.x, texel.y, (line & 2) != 0);
    return mix(word & 0xffffu, word >> 16, (line & 1) != 0);
}
