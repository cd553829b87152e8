// Computes: for each azimuth, light of its wedge from the lowest elevation up to another one, weighted by a Phong lobe
// that peaks in the azimuth's slice: the part of the reflected light that a horizon can hide.
// Reads: azimuths, wedge_rows.
// Writes: specular_tables at [azimuth][elevation][elevation of the peak].
// One invocation is four elevations of the peak in one azimuth, from the lowest row up.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

#include "shared/angle.glsl"
#include "specular/phong_slice.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool HAS_ENVIRONMENT = false;

layout(binding = 0) uniform textureBuffer azimuths;
layout(binding = 1) readonly buffer WedgeRows { vec4 wedge_rows[]; };
layout(binding = 2, rgba32f) uniform writeonly image2DArray specular_tables;

layout(push_constant) uniform SpecularTablesPush {
    vec4 sky;         // radiance of a uniform sky
    int height;       // rows of the environment from pole to pole
    int rows;         // those with light that can arrive
    int peaks;
    int first_peak;   // column of peak 0: tables of several exponents lie side by side
    int nodes;        // elevations: with one, that of the zenith
    int layers;       // azimuths
    float bottom_rad; // the lowest elevation
    float first_rad;  // peak 0
    float step_rad;   // from one peak to the next
    float exponent;
    float wedge_rad;  // of a table that all azimuths share; 0 for the azimuth's own
    float reach_rad;  // angle from the peak beyond which the lobe counts as 0
};

// Sine and cosine of any angle in [-pi, pi].
vec2 direction(float angle) {
    float folded = abs(angle) > HALF_PI ? (angle < 0.0 ? -PI - angle : PI - angle) : angle;
    float c = cosine(folded);
    return vec2(abs(angle) > HALF_PI ? -c : c, sine(folded));
}

void main() {
    int peak = int(gl_GlobalInvocationID.x) * 4;
    int k = int(gl_GlobalInvocationID.y);
    if (peak >= peaks || k >= layers) {
        return;
    }
    vec4 along;
    vec4 up;
    for (int i = 0; i < 4; i++) {
        vec2 of_peak = direction(clamp(first_rad + step_rad * float(peak + i), -PI, PI));
        along[i] = of_peak.x;
        up[i] = of_peak.y;
    }
    vec3 sky_light = sky.rgb * (wedge_rad > 0.0 ? wedge_rad : azimuth_at(azimuths, uint(k)).wedge_rad);
    vec4 red = vec4(0.0);
    vec4 green = vec4(0.0);
    vec4 blue = vec4(0.0);
    // From the lowest elevation that a lobe of the four reaches, to the highest.
    float lower = min(max(first_rad + step_rad * float(peak) - reach_rad, bottom_rad), HALF_PI);
    float last_reached = first_rad + step_rad * float(peak + 3) + reach_rad;
    int row = clamp(int((HALF_PI - lower) / PI * float(height)), 0, rows - 1);
    vec4 below_lower = phong_integral(exponent, along, up, vec4(cosine(lower)), vec4(sine(lower)));
    for (int node = 0; node < nodes; node++) {
        // Of the last node exactly, whatever a quotient rounds to: the loop below ends there.
        float elevation = node == nodes - 1 ? HALF_PI : bottom_rad + (HALF_PI - bottom_rad) * float(node) / float(nodes - 1);
        // Whole rows below the node, then the part of the row that contains it.
        while (lower < min(elevation, last_reached)) {
            float row_top = HALF_PI - PI * float(row) / float(height);
            float upper = min(row_top, elevation);
            vec4 below_upper = phong_integral(exponent, along, up, vec4(cosine(upper)), vec4(sine(upper)));
            vec3 light = sky_light;
            if (HAS_ENVIRONMENT) {
                light += wedge_rows[(k * rows + row) * 3 + 2].rgb;
            }
            vec4 lobe = max(below_upper - below_lower, 0.0);
            red += light.r * lobe;
            green += light.g * lobe;
            blue += light.b * lobe;
            lower = upper;
            below_lower = below_upper;
            row = max(row - (row_top <= elevation ? 1 : 0), 0);
        }
        for (int i = 0; i < 4 && peak + i < peaks; i++) {
            imageStore(specular_tables, ivec3(first_peak + peak + i, node, k), vec4(red[i], green[i], blue[i], 0.0));
        }
    }
}
