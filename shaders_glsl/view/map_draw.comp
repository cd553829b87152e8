// Computes: a shaded field from above as 8-bit sRGB, by thresholds of radiance: a code is the number of thresholds
// reached, so that every pixel equals the host's bit for bit.
// Reads: radiance, tone_steps (texel k: the least radiance of code k, NaN where no radiance has it), voids.
// Writes: picture, four bytes per pixel.
// One invocation is one pixel: the texel at its middle; the mean of PLACES x PLACES texels where a pixel covers
// several; between texels where the map is smooth. A void counts as the texel at the middle. Outside the field, a mean takes
// the texel at the middle, and bilinear interpolation the nearest one.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool GREY = false;
layout(constant_id = 1) const bool HAS_VOIDS = false;
// Constants, as software drivers execute both sides of a branch.
layout(constant_id = 2) const bool IS_SMOOTH = false;   // bilinear
layout(constant_id = 3) const int PLACES = 1;           // along a side: a power of two

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
    float exposure;
    float shoulder;
};

float tone_step(uint code) {
    return texelFetch(tone_steps, ivec2(int(code), 0), 0).x;
}

// The curve of src/scene/tone.rs in f32 errs by less than half a code, so that one threshold decides between two codes.
uint code(float radiance) {
    float rest = 1.0 - shoulder;
    float light = radiance * exposure;
    light = light > 0.0 ? light : 0.0;
    light = light <= shoulder ? light : 1.0 - rest * rest / (light - shoulder + rest);
    float bright = 1.055 * pow(max(light, 1e-9), 1.0 / 2.4) - 0.055;
    float guess = 255.0 * (light <= 0.0031308 ? 12.92 * light : bright);
    uint below = uint(clamp(guess, 0.0, 254.0));
    return below + uint(radiance >= tone_step(below + 1u));
}

bool is_shown(ivec2 at) {
    bool is_inside = at.x >= 0 && at.y >= 0 && at.x < cols && at.y < rows;
    at = clamp(at, ivec2(0), ivec2(cols - 1, rows - 1));
    return is_inside && (!HAS_VOIDS || texelFetch(voids, at, 0).x == 0.0);
}

vec3 light_at(ivec2 at) {
    return texelFetch(radiance, at, 0).rgb;
}

vec3 lit(ivec2 at, vec3 middle) {
    return is_shown(at) ? light_at(at) : middle;
}

// The place of a point of a pixel in the field, columns and rows.
vec2 place(vec2 point) {
    precise vec2 there = point * grid_points_per_pixel;
    there += vec2(first_col, first_row);
    return clamp(there, vec2(-1.0), vec2(cols, rows));
}

vec3 mean(ivec2 pixel, vec3 middle) {
    float share = 1.0 / float(PLACES);
    precise vec3 sum = vec3(0.0);
    for (int i = 0; i < PLACES * PLACES; i++) {
        ivec2 nth = ivec2(i % PLACES, i / PLACES);
        precise vec2 point = vec2(pixel) + (vec2(nth) + 0.5) * share;
        sum += lit(ivec2(floor(place(point))), middle);
    }
    precise vec3 all = sum * (share * share);
    return all;
}

// A texel, or the nearest one inside the field.
vec3 nearest(ivec2 at, vec3 middle) {
    at = clamp(at, ivec2(0), ivec2(cols - 1, rows - 1));
    vec3 light = light_at(at);
    return HAS_VOIDS && texelFetch(voids, at, 0).x != 0.0 ? middle : light;
}

vec3 between(vec2 there) {
    vec3 middle = HAS_VOIDS ? light_at(ivec2(floor(there))) : vec3(0.0);
    precise vec2 from = there - 0.5;
    ivec2 at = ivec2(floor(from));
    precise vec2 part = from - vec2(at);
    vec3 a = nearest(at, middle);
    vec3 b = nearest(at + ivec2(1, 0), middle);
    vec3 c = nearest(at + ivec2(0, 1), middle);
    vec3 d = nearest(at + ivec2(1, 1), middle);
    precise vec3 above = a + (b - a) * part.x;
    precise vec3 below = c + (d - c) * part.x;
    precise vec3 all = above + (below - above) * part.y;
    return all;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= width || pixel.y >= height) {
        return;
    }
    precise vec2 centre = vec2(pixel) + 0.5;
    vec2 there = place(centre);
    ivec2 at = ivec2(floor(there));
    if (!is_shown(at)) {
        imageStore(picture, pixel, uvec4(beyond));
        return;
    }
    vec3 light;
    if (IS_SMOOTH) {
        light = between(there);
    } else {
        light = light_at(at);
        if (PLACES > 1) {
            light = mean(pixel, light);
        }
    }
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
    imageStore(picture, pixel, uvec4(texel));
}
