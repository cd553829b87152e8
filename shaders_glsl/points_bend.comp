// Computes: the direction in which each sample sees, on a curved base, what it sees in each direction of the flat field
// (Heidrich et al. 2000, §5).
// Reads: visible_points, ground, directions (east, north, up), fans. Writes: bent (direction in the sample's own frame; 1
// where the surface is seen, 0 the sky, -1 the ground beyond the field).
// One invocation is one sample and one direction.
//
// What is seen of the sky has no distance. A direction with a neighbour in the net that meets the surface moves as the
// nearest of them would, so that the silhouette between the two keeps its place between them; the others stay.
#version 460

#include "shared/conventions.glsl"
#include "shared/points.glsl"
#include "shared/bend.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint BORDER = 0u;
// Two directions in a word.
layout(constant_id = 1) const bool SMALL = false;
// How far what a repeating field shows is looked for.
layout(constant_id = 2) const int REACH = 128;

layout(binding = 0) uniform utexture2DArray visible_points;
layout(binding = 1) uniform texture2D ground;
layout(binding = 2) uniform textureBuffer directions;
// Of each direction where its triangles begin, how many they are, and the solid angle that they cover; of a triangle the two
// other corners, counter-clockwise.
layout(binding = 3) uniform textureBuffer fans;
layout(binding = 4, rgba32f) uniform writeonly image2DArray bent;

layout(push_constant) uniform PointsBendPush {
    int cols;
    int rows;
    int first_texel;      // of the directions
    int first_fan;        // texel of the first direction's
    int first_direction;  // of this dispatch
    float cell_x_m;
    float cell_y_m;
    float curvature_x;
    float curvature_y;
};

uint seen(int i, ivec2 at) {
    return point_of(texelFetch(visible_points, ivec3(at, SMALL ? i >> 1 : i), 0).x, i, SMALL);
}

// How far along e what is met lies, as far in the plan as the sample `there`, which stands within half a cell of it in the plan
// but on a steep wall far above or below: what moves with the base is off by half a cell's turn, whatever the slope. Of a field
// that repeats, the one of its like that e passes nearest by, and of those equally near the first.
float away_of(ivec2 here, ivec2 there, float own, vec3 e) {
    vec2 cell = vec2(cell_x_m, -cell_y_m);
    float rise = texelFetch(ground, there, 0).x - own;
    ivec2 off = there - here;
    float flat2 = dot(e.xy, e.xy);
    if (flat2 < 1e-12) {
        return 0.0;
    }
    float found = dot(vec2(off) * cell, e.xy);
    vec2 pace = e.xy / cell;  // columns and rows a metre
    bool by_rows = abs(pace.y) > abs(pace.x);
    if (BORDER == BORDER_PERIODIC) {
        ivec2 size = by_rows ? ivec2(rows, cols) : ivec2(cols, rows);
        ivec2 gap = by_rows ? off.yx : off;
        float side = by_rows ? pace.x / pace.y : pace.y / pace.x;
        bool up = (by_rows ? pace.y : pace.x) > 0.0;
        int first = up ? (gap.x < 0 ? gap.x + size.x : gap.x) : (gap.x > 0 ? gap.x - size.x : gap.x);
        float least = 1e38;
        for (int k = 0; k <= max(REACH / size.x, 1); k++) {
            int main_gap = first + (up ? k : -k) * size.x;
            float turns = floor((float(main_gap) * side - float(gap.y)) / float(size.y) + 0.5);
            vec2 gaps = vec2(main_gap, float(gap.y) + turns * float(size.y));
            vec3 to = vec3((by_rows ? gaps.yx : gaps) * cell, rise);
            vec3 beside = to - dot(to, e) * e;
            float miss = dot(beside, beside);
            found = miss < least ? dot(to.xy, e.xy) : found;
            least = min(miss, least);
        }
    }
    return max(found, 0.0) / flat2;
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    int i = first_direction + int(gl_WorkGroupID.z);
    if (at.x >= cols || at.y >= rows) {
        return;
    }
    vec3 e = texelFetch(directions, first_texel + i).xyz;
    float own = texelFetch(ground, at, 0).x;
    uint met = seen(i, at);
    uint by = met;   // what it moves with
    int as = i;
    if (met == SEES_SKY) {
        vec4 fan = texelFetch(fans, first_fan + i);
        float nearest = -2.0;
        for (int k = 0; k < int(fan.y); k++) {
            vec4 pair = texelFetch(fans, int(fan.x) + k);
            for (int corner = 0; corner < 2; corner++) {
                int j = int(pair[corner]);
                uint other = seen(j, at);
                float near = dot(texelFetch(directions, first_texel + j).xyz, e);
                bool is_nearer = other < SEES_LOST && near > nearest;
                nearest = is_nearer ? near : nearest;
                by = is_nearer ? other : by;
                as = is_nearer ? j : as;
            }
        }
    }
    vec3 to = e;
    if (by < SEES_LOST) {
        vec3 with = texelFetch(directions, first_texel + as).xyz;
        float away = away_of(at, ivec2(by & 0xffffu, by >> 16), own, with);
        to = bent_direction(e, away, own, vec2(curvature_x, curvature_y));
    }
    float what = met == SEES_SKY ? 0.0 : (met < SEES_LOST ? 1.0 : -1.0);
    imageStore(bent, ivec3(at, i), vec4(to, what));
}
