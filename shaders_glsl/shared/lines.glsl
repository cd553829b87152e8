#include "shared/sweep.glsl"

// Lines before lane 0 at step 0 that the shear brings onto the field later.
int lattice_lead(int shear, int total_steps, int line_shift, bool periodic) {
    return periodic ? 0 : ((total_steps - 1) * shear + (1 << line_shift) - 1) >> line_shift;
}

int lattice_lines(int lanes, int lead, int line_shift, bool periodic) {
    return periodic ? (lanes * CELL) >> line_shift : (((lanes - 1) * CELL) >> line_shift) + 1 + lead;
}
