#include "shared/conventions.glsl"

// Where a line is at a march step: between lanes `cell` and `cell` + 1, `rest` / shear_den from the
// first. Counted up by line_advance, so that it is exact however long the line.
struct LinePoint {
    int cell;
    uint rest;
};

// Line `line` of an azimuth at march step `step`. Lines are `lines_per_cell` a cell; line 0 is the
// first that meets the field at all.
LinePoint line_point(Azimuth azimuth, int line, int lines_per_cell, int steps, int step) {
    int reach = int((azimuth.shear_num * uint(steps - 1) + azimuth.shear_den - 1u) / azimuth.shear_den);
    uint phase = uint(line % lines_per_cell) * (azimuth.shear_den / uint(lines_per_cell));
    uint advance = phase + uint(step) * azimuth.shear_num;
    return LinePoint(line / lines_per_cell - reach + int(advance / azimuth.shear_den), advance % azimuth.shear_den);
}

LinePoint line_advance(Azimuth azimuth, LinePoint at) {
    at.rest += azimuth.shear_num;
    bool over = at.rest >= azimuth.shear_den;
    at.rest -= over ? azimuth.shear_den : 0u;
    at.cell += over ? 1 : 0;
    return at;
}

// The same line `back` steps earlier.
LinePoint line_retreat(Azimuth azimuth, LinePoint at, int back) {
    uint lost = uint(back) * azimuth.shear_num;
    int cells = int(lost / azimuth.shear_den);
    uint rest = lost % azimuth.shear_den;
    bool under = at.rest < rest;
    return LinePoint(at.cell - cells - (under ? 1 : 0), at.rest + (under ? azimuth.shear_den : 0u) - rest);
}

// A line stands on the field where both its neighbours do, or where it meets the last lane exactly.
bool line_inside(LinePoint at, int lanes) {
    return uint(at.cell) < uint(lanes - 1) || (at.cell == lanes - 1 && at.rest == 0u);
}

// Position along the march axis at a step.
int march_position(Azimuth azimuth, int step, int steps) {
    return (azimuth.flags & AZIMUTH_FLIPS_MARCH) != 0u ? steps - 1 - step : step;
}

// Position along the lane axis of a lane.
int lane_position(Azimuth azimuth, int lane, int lanes) {
    return (azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u ? lanes - 1 - lane : lane;
}
