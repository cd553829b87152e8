// curved_ellipse.ktx2: five ellipses in the plan of the hemisphere, of a flat base and of ones bent by CURVATURE_OUTWARDS and
// CURVATURE_INWARDS (1/m) towards east and towards north: layers 0 to 4 centre and xx, yy of the matrix that takes the unit disc
// to each, 5 and 6 (r) their xy. uv (0, 0) is the north-west corner. Linear in all, so that it may be filtered.

// Whether light from a unit vector of the base's frame (z up, above 0) arrives, or the place is seen from there: 1, or 0. On a
// base of these curvatures towards east and north, 1/m, above 0 where it bends down.
float curved_ellipse_lit(sampler2DArray map, vec2 uv, vec2 curvature, vec3 light) {
    bvec2 inwards = lessThan(curvature, vec2(0.0));
    vec2 share = abs(curvature) / mix(vec2(CURVATURE_OUTWARDS), vec2(CURVATURE_INWARDS), inwards);
    vec4 flat_one = texture(map, vec3(uv, 0.0)), mixed = texture(map, vec3(uv, 5.0));
    vec4 e = flat_one + share.x * (texture(map, vec3(uv, inwards.x ? 2.0 : 1.0)) - flat_one)
        + share.y * (texture(map, vec3(uv, inwards.y ? 4.0 : 3.0)) - flat_one);
    float north = inwards.y ? texture(map, vec3(uv, 6.0)).r : mixed.a;
    float xy = mixed.r + share.x * ((inwards.x ? mixed.b : mixed.g) - mixed.r) + share.y * (north - mixed.r);
    vec2 from = light.xy - e.xy, to = vec2(e.w * from.x - xy * from.y, e.z * from.y - xy * from.x);
    float area = e.z * e.w - xy * xy;
    return e.z + e.w > 0.0 && area > 0.0 && dot(to, to) <= area * area ? 1.0 : 0.0;
}
