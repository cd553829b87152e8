// bent_normal.ktx2: the mean unoccluded direction, and the cone about it with the same solid angle as the unoccluded
// sky.
// uv (0, 0) is the north-west corner; x is east, y north, z up. BENT_Y is -1 where the texture's y is south (DirectX).

// The direction, and the cone's half-angle, radians.
vec4 bent_normal(sampler2D map, vec2 uv) {
    vec4 texel = texture(map, uv);
    if (!BENT_OCTAHEDRAL) {
        return vec4(normalize(texel.xyz * vec3(1.0, BENT_Y, 1.0)), BENT_CONE_SCALE * texel.w);
    }
    vec2 s = 2.0 * texel.xy - 1.0;
    vec2 p = 0.5 * vec2(s.x + s.y, BENT_Y * (s.x - s.y));
    return vec4(normalize(vec3(p, 1.0 - abs(p.x) - abs(p.y))), BENT_CONE_SCALE * texel.z);
}
