// A level's texel: the mean of four bilinear samples of its source around its position (Nowrouzezahrai & Snyder 2009,
// section 9: repeated bilinear decimation). The including shader defines TEXEL, declares `constants` and the constants
// PERIODIC and HOLDS_ENDS, and has `TEXEL source_at(int x, int y)`.

#include "shared/levels.glsl"

layout(push_constant) uniform ReducePush {
    int level;      // the first of the octave's
    int levels;     // of the octave
    int levels_at;  // of level 1 in `constants`, three texels a level
    int width_shift;
    int groups;           // workgroups of all levels
    int first_group[16];  // of each level
};

// The level that an invocation makes, and its source.
int number;
int cols;
int rows;
int first;
int source_cols;
int source_rows;
int source_first;
vec2 ratio;  // source texels per texel
vec2 per_grid_point;

// Finds the invocation's level and texel; false if it has none. Workgroups are numbered level by level, since a row per
// level would idle at small levels. Texel indices are split into two parts that f32 holds exactly.
bool has_texel(out ivec2 texel) {
    int group = int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x);
    int of_octave = 0;
    for (int k = 1; k < levels; k++) {
        of_octave += group >= first_group[k] ? 1 : 0;
    }
    number = level + of_octave;
    int at = levels_at + 3 * (number - 1);
    vec4 made = texelFetch(constants, at);
    cols = int(made.x);
    rows = int(made.y);
    first = int(made.z) << 16 | int(made.w);
    vec4 source = texelFetch(constants, at + 1);
    source_cols = int(source.x);
    source_rows = int(source.y);
    source_first = int(source.z) << 16 | int(source.w);
    vec4 scale = texelFetch(constants, at + 2);
    ratio = scale.xy;
    per_grid_point = scale.zw;
    int beside = group - first_group[of_octave];
    int across = (cols + 7) >> 3;
    // Integer division is slow: divide as floats, then correct by at most one row.
    int row = int(float(beside) / float(across));
    int column = beside - row * across;
    int off = (column < 0 ? -1 : 0) + (column >= across ? 1 : 0);
    texel = ivec2(column - off * across, row + off) * 8 + ivec2(gl_LocalInvocationID.xy);
    return group < groups && texel.x < cols && texel.y < rows;
}

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

TEXEL reduced(ivec2 at) {
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
