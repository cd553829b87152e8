#include "horizon/fuse.glsl"
#include "edit/dirty.glsl"

// Iterates over the azimuths of a batch at four grid points. The including shader declares `azimuths` and the
// constants CAN_RELIGHT and OWN_PLANE_HIDES. It defines add_light and dark_slope, the horizon slope above which an
// azimuth gives no light.

layout(binding = 6) readonly buffer DirtyTexels { uint dirty_texels[]; };
layout(binding = 8) readonly buffer EditList { uint swept_steps; uint word_count; uint light_groups[3]; uint resolve_groups[3]; uint dirty_words[]; };

layout(push_constant) uniform ShadePush {
    int cols;
    int rows;
    float cell_x_m;
    float cell_y_m;
    int warm_up;
    uint first_azimuth;  // of the batch
    uint azimuth_count;
    uint clears;         // 1 in the first batch
    vec4 eye_m;          // specular: the eye, over the field's base; w: 0 for a view from straight above
    vec4 colour;         // specular of a key light: its radiance, times a constant scale; w: 1 where the sum begins
    float exponent;      // of the Phong lobe
    float least_cosine;  // to the lobe's axis, below which light counts as 0
    uint relights;       // 1 after an edit: only the grid points marked in dirty_texels, from the list of their words
    int first_level;     // of a specular map: see levels.glsl
    int level_count;
    float levels_per_log;
    uint along_count;    // azimuths of the batch, the first ones, that follow the cells' diagonals
};

// A branch, not a specialisation constant: frames and edits share a pipeline and therefore round identically.
bool is_relighting() {
    return CAN_RELIGHT && relights != 0u;
}

// First lane and march position of this invocation's four grid points: its place in the field, or after an edit one
// of the eight fours of a word of the list. Past the end of the list none is on the field.
ivec2 place_of_four() {
    if (!is_relighting()) {
        return ivec2(gl_GlobalInvocationID.yx) * ivec2(4, 1);
    }
    uint group = gl_WorkGroupID.y * GROUPS_ACROSS + gl_WorkGroupID.x;
    uint four = group * (8u * LIGHT_GROUP_WORDS) + gl_LocalInvocationIndex;
    ivec2 corner = word_corner(dirty_words[min(four >> 3, word_count - 1u)], cols);
    int i = int(four & 7u);
    ivec2 place = MARCHES_ROWS ? corner + ivec2((i & 1) * 4, i >> 1) : ivec2(corner.y, corner.x + i);
    return (four >> 3) < word_count ? place : ivec2(0x7fffffff);
}

// Which of the four grid points from a lane on are shaded: after an edit only those that it reaches. The same in
// every batch, so that sums stay complete.
bvec4 lit_texels(int lane, int march) {
    if (!is_relighting()) {
        return bvec4(true);
    }
    uint word = dirty_texels[dirty_word(texel_at(lane, march), cols)];
    uvec4 bits = uvec4(dirty_bit(texel_at(lane, march)), dirty_bit(texel_at(lane + 1, march)),
                       dirty_bit(texel_at(lane + 2, march)), dirty_bit(texel_at(lane + 3, march)));
    return notEqual(word & bits, uvec4(0));
}

Azimuth azimuth_of(uint k) {
#ifdef LANE_BUFFER
    if (READS_LANE_BUFFER) {
        return azimuth_from(azimuth_buffer[4u * k], azimuth_buffer[4u * k + 1u], azimuth_buffer[4u * k + 2u],
                            azimuth_buffer[4u * k + 3u]);
    }
#endif
    return azimuth_at(azimuths, k);
}

// `east` and `north` are the surface slopes at the grid points.
void add_azimuth(uint k, Quad q, int lanes, int steps, vec4 east, vec4 north, bool diagonals_along) {
    Azimuth azimuth = azimuth_of(k);
    vec4 lowest = vec4(NO_SLOPE);
    if (OWN_PLANE_HIDES) {
        // Rise of the grid point's own tangent plane along the azimuth (TW10 eq. 4).
        lowest = east * azimuth.cos_phi + north * azimuth.sin_phi;
    }
    // Directions below the own plane need no horizon.
    float dark = dark_slope(azimuth);
    vec4 enough = mix(vec4(dark), vec4(NO_SLOPE), greaterThanEqual(lowest, vec4(dark)));
    lowest = max(fused(azimuth, q, lanes, steps, warm_up, enough, diagonals_along).slope, lowest);
    if (BORDER != BORDER_OPEN) {
        lowest = max(lowest, vec4(0.0));
    }
    add_light(k, azimuth, lowest);
}

// Both loops have fewer crossings to compare than one loop for all azimuths: llvmpipe executes both sides of a branch.
void add_all(Quad q, int lanes, int steps, vec4 east, vec4 north) {
    uint k = first_azimuth;
    if (FUSE == FUSE_AIMED_AROUND) {
        for (; k < first_azimuth + along_count; k++) {
            add_azimuth(k, q, lanes, steps, east, north, true);
        }
    }
    for (; k < first_azimuth + azimuth_count; k++) {
        add_azimuth(k, q, lanes, steps, east, north, false);
    }
}
