// Computes: one more batch of 2^SET_BITS paths from each grid point of some rows, and the mean of all batches so far
// with its standard error, from the variance between batches. Or the same for a list of grid points, indirect light
// only.
// Reads: cells, maxima, ground, lights, environment, environment_cdf, albedo_map, phong_map, places.
// Reads and writes: batch_mean (mean of the batches; w: batch count), batch_spread (sum of squared deviations; w:
// rays), part_sum (of a batch in parts, light so far; w: rays).
// Writes: radiance, standard_error (w: rays so far). Adds to lost_rays.
// One invocation is one grid point, or one entry of the list.
//
// A batch may be split into parts: some of the paths, or some of the lights at each of their vertices. Each part
// follows the same paths; sky and environment belong to the part of the first light.
//
// Features that a scene lacks are not compiled: llvmpipe runs every branch for all lanes. Only loops exit early.
#version 460

#include "shared/conventions.glsl"
#include "reference/random.glsl"
#include "specular/mirror.glsl"
#include "specular/phong_lobe.glsl"
#include "shared/angle.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint BORDER = 0u;
// A field one grid point wide that does not repeat is a line: only rays along it hit it.
layout(constant_id = 1) const bool THIN_ROWS = false;
layout(constant_id = 6) const bool THIN_COLS = false;
layout(constant_id = 2) const uint SET_BITS = 4u;
layout(constant_id = 3) const bool ALBEDO_IS_MAP = false;
layout(constant_id = 4) const bool HAS_ENVIRONMENT = false;
layout(constant_id = 5) const bool HAS_SPECULAR = false;
layout(constant_id = 7) const bool HAS_LIGHTS = false;  // suns, key lights or sphere lights
layout(constant_id = 11) const bool HAS_KEYS = false;
layout(constant_id = 8) const bool HAS_SPHERE_LIGHTS = false;
layout(constant_id = 9) const bool HAS_BOUNCES = false;
// More steps than a ray of this field can take; 60,000 at most, as llvmpipe ends all loops of an invocation together
// after 65,535 iterations.
layout(constant_id = 10) const int MOST_STEPS = 60000;
layout(constant_id = 12) const bool IN_PARTS = false;
layout(constant_id = 13) const bool SPECULAR_IS_MAP = false;
layout(constant_id = 14) const bool AT_PLACES = false;
layout(constant_id = 15) const bool SMOOTH_NORMALS = false;

layout(binding = 0, rgba32f) uniform readonly image2D cells;
layout(binding = 1, r32f) uniform readonly image2D maxima;
layout(binding = 2) uniform texture2D ground;
// One per row: suns, key lights, sphere lights. Sun: direction and 1 - cos of its radius; irradiance facing it,
// spread over its cone. Key light: start and width in turns; sin² of half the zenith angle of its highest and lowest
// elevation; radiance times solid angle. Sphere light: position above the base and radius; radiance.
layout(binding = 3) uniform texture2D lights;
// Radiance; w: sampling density of the texel's directions, 1/sr.
layout(binding = 4) uniform texture2D environment;
// First column: CDF over the rows. Then each row's own CDF over its texels.
layout(binding = 5) uniform texture2D environment_cdf;
layout(binding = 6) uniform texture2D albedo_map;
layout(binding = 7, rgba32f) uniform image2D batch_mean;
layout(binding = 8, rgba32f) uniform image2D batch_spread;
layout(binding = 9, rgba32f) uniform writeonly image2D radiance;
layout(binding = 10, rgba32f) uniform writeonly image2D standard_error;
layout(binding = 11) buffer LostRays { uint lost_rays[]; };
layout(binding = 12, rgba32f) uniform image2D part_sum;
// Phong exponent and scale.
layout(binding = 13) uniform texture2D phong_map;
// Column and row of the grid points of a list, -1 past its end. The sums and images have its size.
layout(binding = 14) uniform texture2D places;

#include "rays/land.glsl"

layout(push_constant) uniform PathTracePush {
    LandPush land;
    float highest_m;
    float rotation_turns;  // of the environment
    int bounces;
    int suns;
    int light_count;
    uint seed;
    int first_row;
    int keys;              // after the suns
    // Devices guarantee 128 bytes, and this struct has 128: the Phong constants are the fourth components of the colours.
    vec4 albedo_exponent;  // albedo where it is constant; w: Phong exponent where it is constant
    vec4 sky_scale;        // radiance of the sky; w: Phong scale where it is constant
    vec4 eye_m;            // over the field's base; w: 0 for a view from straight above
    int first_path;        // of the part; the ends of the path and light ranges are constants
    int last_path;
    int first_light;
    int last_light;
};

#include "rays/trace.glsl"

// A path vertex: on the surface, or at a grid point, whose normal is smooth.
struct Place {
    ivec2 base;
    vec2 offset;
    float own;
    vec3 normal;
    vec3 albedo;
    vec2 specular;  // exponent and scale
    vec3 mirror;    // axis of the Phong lobe
};

// First entry above u among n entries of the CDF from `at` on, `step` apart.
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

ivec2 texel_towards(vec3 e, ivec2 size) {
    vec2 beside = vec2(abs(e.y), length(e.xy)) / max(vec2(abs(e.x), abs(e.z)), vec2(1e-30));
    vec2 angle = arc_tangent(beside.xyxy).xy;
    angle = mix(angle, PI - angle, lessThan(e.xz, vec2(0.0)));
    float azimuth = e.y < 0.0 ? -angle.x : angle.x;
    float turn = fract(0.5 - azimuth / (2.0 * PI) + rotation_turns);
    return min(ivec2(vec2(turn, angle.y / PI) * vec2(size)), size - 1);
}

// An environment direction, drawn in proportion to its texels' light.
vec3 towards_light(vec2 u, vec2 v, ivec2 size, out ivec2 texel) {
    texel.y = picked(u.x, ivec2(0), ivec2(0, 1), size.y);
    texel.x = picked(u.y, ivec2(1, texel.y), ivec2(1, 0), size.x);
    // 1 - cos of the zenith angle: 2 sin² of its half, uniform within the texel.
    float half_row = 0.25 / float(size.y);
    float top = on_circle(float(texel.y) * half_row).y;
    float bottom = on_circle(float(texel.y + 1) * half_row).y;
    float below = 2.0 * mix(top * top, bottom * bottom, v.y);
    float turn = 0.5 - (float(texel.x) + v.x) / float(size.x) + rotation_turns;
    vec2 round = on_circle(turn - floor(turn)) * sqrt(max(below * (2.0 - below), 0.0));
    return vec3(round, 1.0 - below);
}

// A direction of a key light, uniform over its solid angle.
vec3 towards_key(vec4 key, vec2 u) {
    float turn = key.x + key.y * u.y;
    float below = 2.0 * mix(key.z, key.w, u.x);
    vec2 round = on_circle(turn - floor(turn)) * sqrt(max(below * (2.0 - below), 0.0));
    return vec3(round, 1.0 - below);
}

// At a grid point, without its mirror direction.
Place grid_point(ivec2 at) {
    vec4 own = texelFetch(ground, at, 0);
    Place place;
    place.base = at;
    place.offset = vec2(0.0);
    place.own = own.x;
    place.normal = normalize(vec3(-own.y, -own.z, 1.0));
    place.albedo = albedo_exponent.rgb;
    place.specular = vec2(albedo_exponent.w, sky_scale.w);
    place.mirror = vec3(0.0);
    if (ALBEDO_IS_MAP) {
        place.albedo = texelFetch(albedo_map, at, 0).rgb;
    }
    if (SPECULAR_IS_MAP) {
        place.specular = texelFetch(phong_map, at, 0).xy;
    }
    return place;
}

// Mirror direction of the view at a grid point, as in pictures.
vec3 mirror_of_view(Place place) {
    vec2 at_m = vec2(float(place.base.x) * land.cell_x_m, float(land.rows - 1 - place.base.y) * land.cell_y_m);
    vec3 normal = place.normal;
    Mirrored mirror = mirrored(vec4(normal.x), vec4(normal.y), vec4(normal.z), vec4(at_m.x), vec4(at_m.y), vec4(place.own), eye_m);
    return vec3(mirror.east.x, mirror.north.x, mirror.up.x);
}

// The vertex where a ray along e has hit. With smooth normals, one of the triangle's corners, with its barycentric weight as
// the probability: the mean radiance towards the ray is linear between grid points, as in pictures.
Place place_of(Met met, vec3 e, float drawn) {
    // Cells of a repeating field connect its last grid points to its first.
    ivec2 next = ivec2((met.cell.x + 1) % land.cols, (met.cell.y + 1) % land.rows);
    ivec2 third = met.lower ? ivec2(met.cell.x, next.y) : ivec2(next.x, met.cell.y);
    float far = met.lower ? met.offset.x : met.offset.y;
    float near = 1.0 - (met.lower ? met.offset.y : met.offset.x);
    float rest = 1.0 - near - far;
    if (SMOOTH_NORMALS) {
        Place corner = grid_point(drawn < near ? met.cell : drawn < near + far ? next : third);
        corner.mirror = e - 2.0 * dot(e, corner.normal) * corner.normal;
        return corner;
    }
    vec4 corners = imageLoad(cells, met.cell);
    float east = met.lower ? corners.w - corners.z : corners.y - corners.x;
    float south = met.lower ? corners.z - corners.x : corners.w - corners.y;
    Place place;
    place.base = met.cell;
    place.offset = met.offset;
    place.own = corners.x + met.offset.x * east + met.offset.y * south;
    place.normal = normalize(vec3(-east / land.cell_x_m, south / land.cell_y_m, 1.0));
    place.albedo = albedo_exponent.rgb;
    place.specular = vec2(albedo_exponent.w, sky_scale.w);
    place.mirror = e - 2.0 * dot(e, place.normal) * place.normal;
    if (ALBEDO_IS_MAP) {
        vec3 nw = texelFetch(albedo_map, met.cell, 0).rgb;
        vec3 se = texelFetch(albedo_map, next, 0).rgb;
        place.albedo = near * nw + far * se + rest * texelFetch(albedo_map, third, 0).rgb;
    }
    if (SPECULAR_IS_MAP) {
        vec2 nw = texelFetch(phong_map, met.cell, 0).xy;
        vec2 se = texelFetch(phong_map, next, 0).xy;
        // Clamps exponent and scale against rounding.
        place.specular = max(near * nw + far * se + rest * texelFetch(phong_map, third, 0).xy, vec2(0.0));
    }
    return place;
}

// Reflection at a vertex from e, cosine included; the density of scattered rays there, 1/sr; and the quotient of the
// two.
struct Reflected {
    float facing;
    vec3 light;
    float density;
    vec3 scattered;
};

// Fraction of scattered rays drawn from the Phong lobe, where there is one.
float specular_choice(Place place) {
    float most_diffuse = max(place.albedo.r, max(place.albedo.g, place.albedo.b));
    return place.specular.y / max(most_diffuse + place.specular.y, 1e-30);
}

Reflected reflected_from(Place place, vec3 e) {
    float facing = dot(place.normal, e);
    float density = facing / PI;
    Reflected of = Reflected(facing, place.albedo * density, density, place.albedo);
    if (HAS_SPECULAR) {
        float lobe = phong_lobe(e - place.mirror, place.specular.x);
        of.density = mix(density, lobe, specular_choice(place));
        of.light += place.specular.y * lobe;
        of.scattered = of.light / max(of.density, 1e-30);
    }
    return of;
}

// Two points of the sets that belong to ray r of a vertex. Sets of the first vertex are ordered by their first
// coordinate, so that neighbouring lanes' rays have similar steepness and length; a later vertex must be independent
// of the first one's order.
void points_of(uint index, uvec3 key, uint r, bool is_first, out vec2 u, out vec2 v) {
    uvec4 of_u = words_of(uvec4(key.xy, 2u * r, key.z));
    uvec4 of_v = words_of(uvec4(key.xy, 2u * r + 1u, key.z));
    uint mixed_order = shuffled(index, SET_BITS, of_u.z);
    u = net_point(is_first ? index : mixed_order, SET_BITS, of_u);
    v = net_point(shuffled(index, SET_BITS, of_v.z), SET_BITS, of_v);
}

// Light of one path that starts at the grid point. Adds to rays: traced and lost counts.
vec3 path_light(Place place, uint index, uvec3 key, bool alive, inout uvec2 rays) {
    vec2 cell_m = vec2(land.cell_x_m, land.cell_y_m);
    ivec2 env_size = HAS_ENVIRONMENT ? textureSize(environment, 0) : ivec2(1);
    vec3 light = vec3(0.0);
    vec3 carried = vec3(1.0);
    vec2 u;
    vec2 v;
    for (int bounce = 0; bounce <= bounces; bounce++) {
        bool is_first = bounce == 0;
        // Direct light of a list comes from elsewhere, without Monte Carlo noise.
        bool counts = !AT_PLACES || !is_first;
        uint first_ray = uint(bounce * (light_count + 2));
        // At the seam of a repeating field stands its first grid point.
        vec2 from = vec2(place.base) + place.offset;
        from = BORDER == BORDER_PERIODIC ? mix(from, vec2(0.0), equal(from, vec2(land.cols, land.rows))) : from;
        vec3 centre = vec3(from.x * land.cell_x_m, (float(land.rows - 1) - from.y) * land.cell_y_m, place.own);
        if (HAS_LIGHTS) {
            int r = first_light;
            for (; r < last_light; r++) {
                points_of(index, key, first_ray + uint(r), is_first, u, v);
                bool is_far = r < suns + keys;
                vec4 source = texelFetch(lights, ivec2(0, r), 0);
                vec3 colour = texelFetch(lights, ivec2(1, r), 0).rgb;
                vec3 to = is_far ? source.xyz : source.xyz - centre;
                float away = length(to);
                float sine2 = source.w / away;
                sine2 *= sine2;
                float cone = is_far ? source.w : sine2 / (1.0 + sqrt(max(1.0 - sine2, 0.0)));
                // From inside a sphere light, the scattered ray hits it.
                bool shines = is_far || sine2 < 1.0;
                float off = u.x * cone;
                vec3 e = direction_about(away > 0.0 ? to / away : vec3(0.0, 0.0, 1.0), off, u.y);
                if (HAS_KEYS) {
                    vec3 of_key = towards_key(source, u);
                    e = is_far && r >= suns ? of_key : e;
                }
                float beside2 = off * (2.0 - off) * away * away;
                float entry = (1.0 - off) * away - sqrt(max(source.w * source.w - beside2, 0.0));
                float end_m = is_far ? 1e30 : max(entry, 0.0);
                Reflected of = reflected_from(place, e);
                vec3 brought = of.light * colour * (is_far ? 1.0 : 2.0 * PI * cone);
                bool going = alive && counts && shines && of.facing > 0.0 && max(brought.r, max(brought.g, brought.b)) > 0.0;
                Ray ray = ray_from(place.base, place.offset, place.own, e, cell_m);
                float t_end = end_m * min(ray.scale, 1e6);
                Met met = trace(ray, t_end, going);
                rays += uvec2(going ? 1u : 0u, going && met.what == RAY_LOST ? 1u : 0u);
                bool in_view = met.what == RAY_FREE || (!is_far && (met.what != RAY_HIT || met.t >= t_end));
                light += going && in_view ? carried * brought : vec3(0.0);
            }
            // The driver ended a loop early.
            rays.y += r < last_light ? 1u : 0u;
        }
        bool has_sky = first_light == 0;
        if (HAS_ENVIRONMENT && has_sky) {
            points_of(index, key, first_ray + uint(light_count), is_first, u, v);
            ivec2 texel;
            vec3 e = towards_light(u, v, env_size, texel);
            vec4 from_there = texelFetch(environment, texel, 0);
            Reflected of = reflected_from(place, e);
            // The balance heuristic (Veach & Guibas 1995).
            vec3 brought = of.light * from_there.rgb / max(from_there.w + of.density, 1e-30);
            bool going = alive && counts && of.facing > 0.0 && max(brought.r, max(brought.g, brought.b)) > 0.0;
            Met met = trace(ray_from(place.base, place.offset, place.own, e, cell_m), 1e30, going);
            rays += uvec2(going ? 1u : 0u, going && met.what == RAY_LOST ? 1u : 0u);
            light += going && met.what == RAY_FREE ? carried * brought : vec3(0.0);
        }
        points_of(index, key, first_ray + uint(light_count + 1), is_first, u, v);
        bool by_specular = HAS_SPECULAR && v.x < specular_choice(place);
        // Uniform over a sphere tangent to the surface point, as directions from there: cosine-distributed.
        vec3 e = normalize(place.normal + vec3(on_circle(u.y) * sqrt(4.0 * u.x * (1.0 - u.x)), 1.0 - 2.0 * u.x));
        if (HAS_SPECULAR) {
            float near_mirror = pow(max(u.x, 1e-30), 1.0 / (place.specular.x + 1.0));
            vec3 about_mirror = direction_about(place.mirror, 1.0 - near_mirror, u.y);
            e = by_specular ? about_mirror : e;
        }
        Reflected of = reflected_from(place, e);
        float most_scattered = max(of.scattered.r, max(of.scattered.g, of.scattered.b));
        bool going = alive && of.facing > 0.0 && most_scattered > 0.0;
        Ray ray = ray_from(place.base, place.offset, place.own, e, cell_m);
        Met met = trace(ray, 1e30, going);
        rays += uvec2(going ? 1u : 0u, going && met.what == RAY_LOST ? 1u : 0u);
        vec3 arriving = has_sky ? sky_scale.rgb : vec3(0.0);
        if (HAS_ENVIRONMENT && has_sky) {
            vec4 from_there = texelFetch(environment, texel_towards(e, env_size), 0);
            arriving += from_there.rgb * (of.density / max(of.density + from_there.w, 1e-30));
        }
        arriving = met.what == RAY_FREE ? arriving : vec3(0.0);
        if (HAS_SPHERE_LIGHTS) {
            int i = max(suns + keys, first_light);
            for (; i < last_light; i++) {
                vec4 sphere = texelFetch(lights, ivec2(0, i), 0);
                vec3 to = sphere.xyz - centre;
                float ahead = dot(to, e);
                float inside = sphere.w * sphere.w - dot(to, to);
                float exit_m = ahead + sqrt(max(ahead * ahead + inside, 0.0));
                bool in_view = inside >= 0.0 && (met.what != RAY_HIT || met.t >= exit_m * ray.scale);
                arriving += in_view ? texelFetch(lights, ivec2(1, i), 0).rgb : vec3(0.0);
            }
            rays.y += i < last_light ? 1u : 0u;
        }
        light += going && counts ? carried * of.scattered * arriving : vec3(0.0);
        if (HAS_BOUNCES) {
            alive = going && met.what == RAY_HIT;
            place = place_of(met, e, v.y);
            carried *= of.scattered;
        }
        if (!HAS_BOUNCES || !alive) {
            break;
        }
    }
    return light;
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, first_row);
    ivec2 size = AT_PLACES ? textureSize(places, 0) : ivec2(land.cols, land.rows);
    bool alive = at.x < size.x && at.y < size.y;
    // Texel of the sums, and of the grid point.
    ivec2 slot = min(at, size - 1);
    ivec2 here = slot;
    if (AT_PLACES) {
        ivec2 listed = ivec2(texelFetch(places, slot, 0).xy);
        alive = alive && listed.x >= 0;
        here = max(listed, ivec2(0));
    }
    Place place = grid_point(here);
    if (HAS_SPECULAR) {
        // Only the first vertex is viewed from the eye; each later one from the vertex before it.
        place.mirror = mirror_of_view(place);
    }
    vec4 before = imageLoad(batch_mean, slot);
    // A grid point listed twice gets different paths each time.
    uvec3 key = uvec3(uint(slot.y * land.cols + slot.x), uint(before.w), seed);
    uvec2 rays = uvec2(0u);
    vec3 sum = vec3(0.0);
    int i = first_path;
    for (; i < last_path; i++) {
        sum += path_light(place, uint(i), key, alive, rays);
    }
    rays.y += i < last_path ? 1u : 0u;
    if (alive && rays.y > 0u) {
        atomicAdd(lost_rays[0], rays.y);
    }
    if (IN_PARTS) {
        vec4 earlier = imageLoad(part_sum, slot);
        bool begins = first_path == 0 && first_light == 0;
        vec4 so_far = vec4(sum, float(rays.x)) + (begins ? vec4(0.0) : earlier);
        if (alive) {
            imageStore(part_sum, at, so_far);
        }
        if (last_path < (1 << SET_BITS) || last_light < light_count) {
            return;
        }
        sum = so_far.rgb;
        rays.x = uint(so_far.w);
    }
    // Welford 1962, over batches.
    vec3 batch = sum / float(1u << SET_BITS);
    float n = before.w + 1.0;
    vec3 off = batch - before.rgb;
    vec3 mean = before.rgb + off / n;
    vec4 kept = imageLoad(batch_spread, slot);
    vec3 spread = before.w > 0.0 ? kept.rgb : vec3(0.0);
    float rays_so_far = float(rays.x) + (before.w > 0.0 ? kept.w : 0.0);
    spread += off * (batch - mean);
    // One batch has no variance.
    vec3 error = n > 1.0 ? sqrt(max(spread, 0.0) / (n * (n - 1.0))) : vec3(uintBitsToFloat(0x7f800000u));
    if (alive) {
        imageStore(batch_mean, at, vec4(mean, n));
        imageStore(batch_spread, at, vec4(spread, rays_so_far));
        imageStore(radiance, at, vec4(mean, 1.0));
        imageStore(standard_error, at, vec4(error, rays_so_far));
    }
}
