// Computes: one more batch of 2^SET_BITS light paths a sample, and the mean of all batches so far with its
// standard error, from the spread between batches.
// Reads: cells, maxima, ground, lights, environment, environment_cdf, albedo_map. Reads and writes:
// batch_mean (mean of the batches; w: how many), batch_spread (sum of squares about it). Writes: radiance,
// standard_error. Adds to lost_rays.
// One invocation is one sample.
#version 460
#extension GL_KHR_shader_subgroup_vote : require

#include "shared/conventions.glsl"
#include "shared/random.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint BORDER = 0u;
// A field one sample wide that does not repeat is a line: only rays along it meet it.
layout(constant_id = 1) const bool THIN_ROWS = false;
layout(constant_id = 6) const bool THIN_COLS = false;
layout(constant_id = 2) const uint SET_BITS = 4u;
layout(constant_id = 3) const bool ALBEDO_IS_MAP = false;
layout(constant_id = 4) const bool HAS_ENVIRONMENT = false;
layout(constant_id = 5) const bool HAS_LOBE = false;

layout(binding = 0) uniform texture2D cells;
layout(binding = 1) uniform texture2D maxima;
layout(binding = 2) uniform texture2D ground;
// One a row. A sun: its direction and 1 - cos of its radius; irradiance facing it, spread over its cone.
// A ball: its place above the base and its radius; radiance.
layout(binding = 3) uniform texture2D lights;
layout(binding = 4) uniform texture2D environment;
// First column: the share of the rows down to each. Then each row's own: of its texels up to each.
layout(binding = 5) uniform texture2D environment_cdf;
layout(binding = 6) uniform texture2D albedo_map;
layout(binding = 7, rgba32f) uniform image2D batch_mean;
layout(binding = 8, rgba32f) uniform image2D batch_spread;
layout(binding = 9, rgba32f) uniform writeonly image2D radiance;
layout(binding = 10, rgba32f) uniform writeonly image2D standard_error;
layout(binding = 11) buffer LostRays { uint lost_rays[]; };

layout(push_constant) uniform PathTracePush {
    int cols;
    int rows;
    int cells_x;
    int cells_y;
    int padded_rows;
    int top_level;
    float highest_m;
    float cell_x_m;
    float cell_y_m;
    float rotation_turns;  // of the environment
    float exponent;        // of the lobe
    float lobe_share;      // what the lobe reflects
    int bounces;
    int suns;
    int light_count;
    uint seed;
    vec4 albedo;           // where it is constant
    vec4 sky;
};

#include "shared/trace.glsl"

// Where a path stands: on the surface, or at a sample, whose normal is smooth.
struct Place {
    ivec2 base;
    vec2 offset;
    float own;
    vec3 normal;
    vec3 albedo;
    bool has_lobe;
};

// The direction about which the lobe lies, and its density there.
vec3 mirror;
float lobe_density(vec3 e) {
    // The built-in power is off by 1e-3 at exponents of 1e4. 1 - cos from the difference keeps its digits
    // near the mirror direction, and ln(1 - m) = -2 atanh(m / (2 - m)), a series to 1e-7 up to m = 1/2.
    vec3 apart = e - mirror;
    float m = 0.5 * dot(apart, apart);
    float z = m / (2.0 - m);
    float s = z * z;
    float series = 1.0 + s * (1.0 / 3.0 + s * (1.0 / 5.0 + s * (1.0 / 7.0 + s * (1.0 / 9.0 + s * (1.0 / 11.0 + s / 13.0)))));
    float power = exponent * (m < 0.5 ? -2.0 * z * series : log(max(1.0 - m, 1e-30)));
    return m < 1.0 ? (exponent + 1.0) / (2.0 * PI) * exp(power) : 0.0;
}

// First entry above u of n entries of the CDF from `at` on, `step` apart.
int picked(float u, ivec2 at, ivec2 step, int n) {
    int low = 0;
    int high = n - 1;
    for (int i = 0; i < 31 && (1 << i) < 2 * n; i++) {
        int middle = (low + high) >> 1;
        bool above = texelFetch(environment_cdf, at + middle * step, 0).x > u;
        high = low < high && above ? middle : high;
        low = low < high && !above ? middle + 1 : low;
    }
    return low;
}

// Share of entry i.
float share(int i, ivec2 at, ivec2 step) {
    float before = texelFetch(environment_cdf, at + max(i - 1, 0) * step, 0).x;
    return texelFetch(environment_cdf, at + i * step, 0).x - (i > 0 ? before : 0.0);
}

// Density of the environment's sampling in a texel, a steradian; its solid angle is
// (2 pi / width) (cos a - cos b), written without cancellation.
float texel_density(ivec2 texel, ivec2 size) {
    float half_row = 0.5 * PI / float(size.y);
    float middle = (2.0 * float(texel.y) + 1.0) * half_row;
    float solid = 2.0 * PI / float(size.x) * 2.0 * sin(middle) * sin(half_row);
    float row_share = share(texel.y, ivec2(0), ivec2(0, 1));
    float texel_share = share(texel.x, ivec2(1, texel.y), ivec2(1, 0));
    return row_share * texel_share / solid;
}

ivec2 texel_towards(vec3 e, ivec2 size) {
    float turn = fract(0.5 - atan(e.y, e.x) / (2.0 * PI) + rotation_turns);
    float down = acos(clamp(e.z, -1.0, 1.0)) / PI;
    return min(ivec2(vec2(turn, down) * vec2(size)), size - 1);
}

// A direction of the environment, by the light of its texels.
vec3 towards_light(vec2 u, vec2 v, ivec2 size, out ivec2 texel) {
    texel.y = picked(u.x, ivec2(0), ivec2(0, 1), size.y);
    texel.x = picked(u.y, ivec2(1, texel.y), ivec2(1, 0), size.x);
    // 1 - cos of the zenith angle: 2 sin² of half of it, and evenly on.
    float half_row = 0.5 * PI / float(size.y);
    float top = sin(float(texel.y) * half_row);
    float bottom = sin(float(texel.y + 1) * half_row);
    float below = 2.0 * mix(top * top, bottom * bottom, v.y);
    float turn = 0.5 - (float(texel.x) + v.x) / float(size.x) + rotation_turns;
    vec2 round = on_circle(turn - floor(turn)) * sqrt(max(below * (2.0 - below), 0.0));
    return vec3(round, 1.0 - below);
}

Place place_of(Met met) {
    vec4 corners = texelFetch(cells, met.cell, 0);
    float east = met.lower ? corners.w - corners.z : corners.y - corners.x;
    float south = met.lower ? corners.z - corners.x : corners.w - corners.y;
    Place place;
    place.base = met.cell;
    place.offset = met.offset;
    place.own = corners.x + met.offset.x * east + met.offset.y * south;
    place.normal = normalize(vec3(-east / cell_x_m, south / cell_y_m, 1.0));
    place.albedo = albedo.rgb;
    place.has_lobe = false;
    if (ALBEDO_IS_MAP) {
        // Cells of a field that repeats lead from its last samples to its first.
        ivec2 next = ivec2((met.cell.x + 1) % cols, (met.cell.y + 1) % rows);
        vec3 nw = texelFetch(albedo_map, met.cell, 0).rgb;
        vec3 se = texelFetch(albedo_map, next, 0).rgb;
        vec3 third = texelFetch(albedo_map, met.lower ? ivec2(met.cell.x, next.y) : ivec2(next.x, met.cell.y), 0).rgb;
        float far = met.lower ? met.offset.x : met.offset.y;
        float near = 1.0 - (met.lower ? met.offset.y : met.offset.x);
        place.albedo = near * nw + far * se + (1.0 - near - far) * third;
    }
    return place;
}

// Light of one path that begins at the sample.
vec3 path_light(Place place, uint index, uvec3 key, bool alive, inout uint lost) {
    vec2 cell_m = vec2(cell_x_m, cell_y_m);
    ivec2 env_size = HAS_ENVIRONMENT ? textureSize(environment, 0) : ivec2(1);
    int rays = light_count + (HAS_ENVIRONMENT ? 2 : 1);
    vec3 light = vec3(0.0);
    vec3 carried = vec3(1.0);
    for (int bounce = 0; bounce <= bounces; bounce++) {
        if (!subgroupAny(alive)) {
            break;
        }
        Place next = place;
        vec3 onward = vec3(0.0);
        bool goes_on = false;
        // Where a field that repeats begins again stands its first sample.
        vec2 from = vec2(place.base) + place.offset;
        from = BORDER == BORDER_PERIODIC ? mix(from, vec2(0.0), equal(from, vec2(cols, rows))) : from;
        vec3 centre = vec3(from.x * cell_x_m, (float(rows - 1) - from.y) * cell_y_m, place.own);
        // First towards each light, then where the surface scatters to.
        for (int r = 0; r < rays; r++) {
            uint dimension = 2u * uint(bounce * rays + r);
            vec2 u = set_point(index, SET_BITS, mixed(uvec4(key.xy, dimension, key.z)));
            vec2 v = set_point(index, SET_BITS, mixed(uvec4(key.xy, dimension + 1u, key.z)));
            bool scatters = r == rays - 1;
            bool is_sun = r < suns;
            bool is_light = r < light_count;
            vec4 source = texelFetch(lights, ivec2(0, min(r, max(light_count - 1, 0))), 0);
            vec3 colour = texelFetch(lights, ivec2(1, min(r, max(light_count - 1, 0))), 0).rgb;
            vec3 e;
            float end_m = 1e30;
            bool shines = true;
            float env_density = 0.0;
            vec3 weight = vec3(0.0);
            if (is_light) {
                vec3 to = is_sun ? source.xyz : source.xyz - centre;
                float away = length(to);
                float sine2 = source.w / away;
                sine2 *= sine2;
                float cone = is_sun ? source.w : sine2 / (1.0 + sqrt(max(1.0 - sine2, 0.0)));
                // Inside a ball the scattered ray finds it.
                shines = is_sun || sine2 < 1.0;
                float off = u.x * cone;
                e = direction_about(away > 0.0 ? to / away : vec3(0.0, 0.0, 1.0), off, u.y);
                float beside2 = off * (2.0 - off) * away * away;
                float entry = (1.0 - off) * away - sqrt(max(source.w * source.w - beside2, 0.0));
                end_m = is_sun ? 1e30 : max(entry, 0.0);
                weight = colour * (is_sun ? 1.0 : 2.0 * PI * cone);
            } else if (!scatters) {
                ivec2 texel;
                e = towards_light(u, v, env_size, texel);
                env_density = texel_density(texel, env_size);
                weight = texelFetch(environment, texel, 0).rgb;
            } else {
                float most = max(place.albedo.r, max(place.albedo.g, place.albedo.b));
                bool by_lobe = HAS_LOBE && place.has_lobe && v.x * (most + lobe_share) < lobe_share;
                float cosine = by_lobe ? pow(max(u.x, 1e-30), 1.0 / (exponent + 1.0)) : sqrt(1.0 - u.x);
                e = direction_about(by_lobe ? mirror : place.normal, 1.0 - cosine, u.y);
            }
            float facing = dot(place.normal, e);
            shines = shines && facing > 0.0;
            // What the surface reflects from e, the cosine included, and the density of the scattered ray.
            float density = facing / PI;
            vec3 reflected = place.albedo * density;
            vec3 scattered = place.albedo;
            if (HAS_LOBE) {
                float lobe = lobe_density(e);
                float most = max(place.albedo.r, max(place.albedo.g, place.albedo.b));
                float by_lobe = most + lobe_share > 0.0 ? lobe_share / (most + lobe_share) : 0.0;
                float both = mix(density, lobe, by_lobe);
                vec3 sum = reflected + lobe_share * lobe;
                density = place.has_lobe ? both : density;
                reflected = place.has_lobe ? sum : reflected;
                scattered = place.has_lobe ? sum / max(both, 1e-30) : scattered;
            }
            // The balance heuristic (Veach & Guibas 1995).
            bool is_env = HAS_ENVIRONMENT && !is_light && !scatters;
            weight = is_env ? weight / max(env_density + density, 1e-30) : weight;
            vec3 share_of = scatters ? scattered : reflected * weight;
            bool going = alive && shines && max(share_of.r, max(share_of.g, share_of.b)) > 0.0;
            Ray ray = ray_from(place.base, place.offset, place.own, e, cell_m);
            float t_end = end_m * min(ray.scale, 1e6);
            Met met = trace(ray, t_end, going);
            lost += going && met.what == RAY_LOST ? 1u : 0u;
            bool is_free = met.what == RAY_FREE;
            if (!scatters) {
                bool is_ball = is_light && !is_sun;
                bool in_view = is_ball ? met.what != RAY_HIT || met.t >= t_end : is_free;
                light += going && in_view ? carried * share_of : vec3(0.0);
            } else {
                vec3 seen = sky.rgb;
                if (HAS_ENVIRONMENT) {
                    ivec2 texel = texel_towards(e, env_size);
                    float other = texel_density(texel, env_size);
                    seen += texelFetch(environment, texel, 0).rgb * (density / max(density + other, 1e-30));
                }
                seen = is_free ? seen : vec3(0.0);
                for (int i = suns; i < light_count; i++) {
                    vec4 ball = texelFetch(lights, ivec2(0, i), 0);
                    vec3 to = ball.xyz - centre;
                    float ahead = dot(to, e);
                    float inside = ball.w * ball.w - dot(to, to);
                    float exit_m = ahead + sqrt(max(ahead * ahead + inside, 0.0));
                    bool in_view = inside >= 0.0 && (met.what != RAY_HIT || met.t >= exit_m * ray.scale);
                    seen += in_view ? texelFetch(lights, ivec2(1, i), 0).rgb : vec3(0.0);
                }
                light += going ? carried * share_of * seen : vec3(0.0);
                goes_on = going && met.what == RAY_HIT;
                next = place_of(met);
                onward = share_of;
            }
        }
        carried *= onward;
        place = next;
        alive = goes_on;
    }
    return light;
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    bool alive = at.x < cols && at.y < rows;
    ivec2 here = min(at, ivec2(cols, rows) - 1);
    vec4 own = texelFetch(ground, here, 0);
    Place place;
    place.base = here;
    place.offset = vec2(0.0);
    place.own = own.x;
    place.normal = normalize(vec3(-own.y, -own.z, 1.0));
    place.albedo = albedo.rgb;
    place.has_lobe = HAS_LOBE;
    if (ALBEDO_IS_MAP) {
        place.albedo = texelFetch(albedo_map, here, 0).rgb;
    }
    // Seen from straight above.
    mirror = 2.0 * place.normal.z * place.normal - vec3(0.0, 0.0, 1.0);
    vec4 before = imageLoad(batch_mean, here);
    uvec3 key = uvec3(uint(here.y * cols + here.x), uint(before.w), seed);
    uint lost = 0u;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < (1u << SET_BITS); i++) {
        sum += path_light(place, i, key, alive, lost);
    }
    // Welford 1962, over batches.
    vec3 batch = sum / float(1u << SET_BITS);
    float n = before.w + 1.0;
    vec3 off = batch - before.rgb;
    vec3 mean = before.rgb + off / n;
    vec3 spread = before.w > 0.0 ? imageLoad(batch_spread, here).rgb : vec3(0.0);
    spread += off * (batch - mean);
    // One batch says nothing of the spread.
    vec3 error = n > 1.0 ? sqrt(max(spread, 0.0) / (n * (n - 1.0))) : vec3(uintBitsToFloat(0x7f800000u));
    if (alive) {
        imageStore(batch_mean, at, vec4(mean, n));
        imageStore(batch_spread, at, vec4(spread, 0.0));
        imageStore(radiance, at, vec4(mean, 1.0));
        imageStore(standard_error, at, vec4(error, 0.0));
        if (lost > 0u) {
            atomicAdd(lost_rays[0], lost);
        }
    }
}
