// A level's texel: the mean of four bilinear samples of its source around its position (Nowrouzezahrai & Snyder 2009,
// section 9: repeated bilinear decimation). The including shader defines TEXEL, declares the constants PERIODIC and
// HOLDS_ENDS, and has `TEXEL source_at(int x, int y)`.

#include "shared/levels.glsl"

layout(push_constant) uniform ReducePush {
    int cols;
    int rows;
    int first;
    int source_cols;
    int source_rows;
    int source_first;
    float ratio_x;  // source texels per texel
    float ratio_y;
    float per_grid_point_x;
    float per_grid_point_y;
    int level;
    int width_shift;
};

TEXEL source_at(int x, int y);

// Two neighbouring texels of an axis, and the fraction between them. Beyond the ends the last two are extrapolated
// linearly, or the last is held.
struct Between {
    int low;
    int high;
    float t;
};

Between between(float place, int count) {
    int cell = int(floor(place));
    int held = clamp(cell, 0, max(count - 2, 0));
    int before = wrapped(cell, count);
    int after = wrapped(cell + 1, count);
    int next = min(held + 1, count - 1);
    cell = PERIODIC ? cell : held;
    float t = place - float(cell);
    float within = clamp(t, 0.0, 1.0);
    return Between(PERIODIC ? before : held, PERIODIC ? after : next, HOLDS_ENDS ? within : t);
}

TEXEL row_at(Between x, int y) {
    TEXEL low = source_at(x.low, y);
    return low + x.t * (source_at(x.high, y) - low);
}

TEXEL bilinear(Between x, Between y) {
    TEXEL low = row_at(x, y.low);
    return low + y.t * (row_at(x, y.high) - low);
}

TEXEL reduced(ivec2 at, vec2 ratio) {
    // At ratio 1 all four are the texel itself, at 2 their weights are 1, 2, 1.
    float beside_x = 0.5 * (ratio.x - 1.0);
    float beside_y = 0.5 * (ratio.y - 1.0);
    precise float place_x = float(at.x) * ratio.x;
    precise float place_y = float(at.y) * ratio.y;
    Between west = between(place_x - beside_x, source_cols);
    Between east = between(place_x + beside_x, source_cols);
    Between north = between(place_y - beside_y, source_rows);
    Between south = between(place_y + beside_y, source_rows);
    return 0.25 * ((bilinear(west, north) + bilinear(east, north)) + (bilinear(west, south) + bilinear(east, south)));
}
