// Computes: a shaded field from above as 8-bit sRGB, by thresholds of radiance: a code is the number of thresholds
// reached, so that every pixel equals the host's bit for bit.
// Reads: radiance, tone_steps (texel k: the least radiance of code k, NaN where no radiance has it), voids.
// Writes: picture, four bytes per pixel.
// One invocation is one pixel.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool GREY = false;
layout(constant_id = 1) const bool HAS_VOIDS = false;

layout(binding = 0) uniform texture2D radiance;
layout(binding = 1) uniform texture2D tone_steps;
layout(binding = 2) uniform texture2D voids;
layout(binding = 3, r32ui) uniform writeonly uimage2D picture;

layout(push_constant) uniform MapDrawPush {
    int width;
    int height;
    int cols;
    int rows;
    float first_col;          // of the picture's upper left corner
    float first_row;
    float grid_points_per_pixel;
    uint swaps;               // not 0: BGRA order
    uint beyond;              // the pixel outside the field
};

uint code(float light) {
    uint reached = 0u;
    for (uint step = 128u; step > 0u; step >>= 1) {
        uint next = reached + step;
        reached = light >= texelFetch(tone_steps, ivec2(next, 0), 0).x ? next : reached;
    }
    return reached;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= width || pixel.y >= height) {
        return;
    }
    precise vec2 place = (vec2(pixel) + 0.5) * grid_points_per_pixel;
    precise vec2 from = vec2(first_col, first_row);
    place += from;
    ivec2 at = ivec2(floor(clamp(place, vec2(-1.0), vec2(cols, rows))));
    bool is_inside = at.x >= 0 && at.y >= 0 && at.x < cols && at.y < rows;
    at = clamp(at, ivec2(0), ivec2(cols - 1, rows - 1));
    if (HAS_VOIDS) {
        is_inside = is_inside && texelFetch(voids, at, 0).x == 0.0;
    }
    vec3 light = texelFetch(radiance, at, 0).rgb;
    uint red = code(light.r);
    uint green = red;
    uint blue = red;
    if (!GREY) {
        green = code(light.g);
        blue = code(light.b);
    }
    uint low = swaps != 0u ? blue : red;
    uint high = swaps != 0u ? red : blue;
    uint texel = low | green << 8 | high << 16 | 0xff000000u;
    imageStore(picture, pixel, uvec4(is_inside ? texel : beyond));
}
