// ellipse.ktx2: layer 0 is the centre and the unit axis, layer 1 the inverse radii along and across it, in the plan
// of the hemisphere: a direction's x (east) and y (north). uv (0, 0) is the north-west corner. Use nearest texels:
// ellipses of different axes cannot be interpolated.

vec4 ellipse_part(sampler2DArray map, vec2 uv, int part) {
    ivec2 size = textureSize(map, 0).xy;
    return texelFetch(map, ivec3(clamp(ivec2(uv * vec2(size)), ivec2(0), size - 1), part), 0);
}

// Visibility, 0 or 1, along a unit vector (z up, above 0).
float ellipse_lit(sampler2DArray map, vec2 uv, vec3 light) {
    vec4 axes = ellipse_part(map, uv, 0);
    vec2 from = light.xy - axes.xy;
    vec2 at = ellipse_part(map, uv, 1).xy * vec2(dot(axes.zw, from), axes.z * from.y - axes.w * from.x);
    return dot(at, at) <= 1.0 ? 1.0 : 0.0;
}
