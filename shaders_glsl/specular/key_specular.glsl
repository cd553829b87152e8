#include "specular/phong_slice.glsl"
#include "specular/mirror.glsl"

// Light of a key light's wedge of radiance 1 in Phong lobes about the mirror directions of four grid points, above `lowest`: the
// slope of the lowest direction that is not hidden. The lobe's slice in the middle of the wedge represents the whole wedge.
vec4 key_specular(float n, Azimuth azimuth, Mirrored mirror, vec4 lowest) {
    vec4 along = mirror.east * azimuth.cos_phi + mirror.north * azimuth.sin_phi;
    vec4 across = mirror.east * azimuth.sin_phi - mirror.north * azimuth.cos_phi;
    vec4 within = along * along + mirror.up * mirror.up;
    vec4 power = off_slice(vec4(n), across, within);
    // Farther away a lobe has less than 1e-7 of its peak.
    if (all(lessThan(power, vec4(1e-7)))) {
        return vec4(0.0);
    }
    vec4 shorten = inversesqrt(max(within, vec4(1e-30)));
    along *= shorten;
    vec4 up = mirror.up * shorten;
    float high = azimuth.high_slope;
    vec4 low = max(lowest, vec4(azimuth.low_slope));
    vec4 cos_high = vec4(inversesqrt(1.0 + high * high));
    vec4 cos_low = inversesqrt(1.0 + low * low);
    vec4 slice = phong_integral(n, along, up, cos_high, high * cos_high) - phong_integral(n, along, up, cos_low, low * cos_low);
    return mix(vec4(0.0), power * azimuth.wedge_rad * max(slice, 0.0), lessThan(low, vec4(high)));
}
