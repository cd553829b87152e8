// scatter.ktx2: layer 0 is exit radiance, linear RGB; layer 1 is its standard error (one sigma).
// uv (0, 0) is the north-west corner.
vec3 scatter(sampler2DArray map, vec2 uv) {
    return texture(map, vec3(uv, 0.0)).rgb;
}

vec3 scatter_error(sampler2DArray map, vec2 uv) {
    return texture(map, vec3(uv, 1.0)).rgb;
}
