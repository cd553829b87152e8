// curved_ellipse.ktx2: five ellipses in the plan of the hemisphere, for a flat base surface and for ones of curvature
// CURVATURE_OUTWARDS and CURVATURE_INWARDS (1/m) towards east and towards north. Layers 0 to 4 hold the centre and
// xx, yy of the matrix that maps the unit disc to each ellipse; layers 5 and 6 (r) hold their xy. uv (0, 0) is the
// north-west corner. Linear in all values, so that the map may be filtered.

// Visibility, 0 or 1, along a unit vector of the base's frame (z up, above 0). The base has these curvatures towards
// east and north, 1/m, positive where it bends down.
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
