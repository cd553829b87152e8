// Computes: a shaded field from above as 8-bit sRGB, by thresholds of radiance: a code is the number of thresholds
// reached, so that every pixel equals the host's bit for bit.
// Reads: radiance, tone_steps (texel k: the least radiance of code k, NaN where no radiance has it), voids.
// Writes: picture, four bytes per pixel.
// One invocation is one pixel: the texel at its middle; the mean of PLACES x PLACES texels where a pixel covers
// several; between texels where the map is smooth. Voids and texels outside count as the middle one.
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
    int places;              // along a side: a power of two
    uint is_smooth;           // not 0: bilinear, with one place
};

float tone_step(uint code) {
    return texelFetch(tone_steps, ivec2(int(code), 0), 0).x;
}

// Linear light of sRGB 127.5/255, the threshold of code 128.
const float HALF_CODE = 0.214041;
const float SHOULDER = 0.8;
const float REST = 1.0 - SHOULDER;

// sRGB with the shoulder of a picture's tone gives a first guess, which the steps correct: they are those of any curve.
uint code(float radiance, float exposure) {
    float light = max(radiance * exposure, 0.0);
    light = light <= SHOULDER ? light : 1.0 - REST * REST / (light - SHOULDER + REST);
    float bright = 255.0 * (1.055 * pow(max(light, 1e-9), 1.0 / 2.4) - 0.055);
    float guess = light <= 0.0031308 ? 255.0 * 12.92 * light : bright;
    uint reached = guess >= 0.0 && guess <= 255.0 ? uint(guess + 0.5) : 0u;
    while (reached > 0u && !(radiance >= tone_step(reached))) {
        reached--;
    }
    while (reached < 255u && radiance >= tone_step(reached + 1u)) {
        reached++;
    }
    return reached;
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
    float share = 1.0 / float(places);
    precise vec3 sum = vec3(0.0);
    for (int i = 0; i < places * places; i++) {
        ivec2 nth = ivec2(i % places, i / places);
        precise vec2 point = vec2(pixel) + (vec2(nth) + 0.5) * share;
        sum += lit(ivec2(floor(place(point))), middle);
    }
    precise vec3 all = sum * (share * share);
    return all;
}

vec3 between(vec2 there) {
    precise vec2 from = there - 0.5;
    ivec2 at = ivec2(floor(from));
    precise vec2 part = from - vec2(at);
    bool is_inner = !HAS_VOIDS && at.x >= 0 && at.y >= 0 && at.x + 1 < cols && at.y + 1 < rows;
    vec3 a, b, c, d;
    if (is_inner) {
        a = light_at(at);
        b = light_at(at + ivec2(1, 0));
        c = light_at(at + ivec2(0, 1));
        d = light_at(at + ivec2(1, 1));
    } else {
        vec3 middle = light_at(ivec2(floor(there)));
        a = lit(at, middle);
        b = lit(at + ivec2(1, 0), middle);
        c = lit(at + ivec2(0, 1), middle);
        d = lit(at + ivec2(1, 1), middle);
    }
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
    if (places == 1 && is_smooth != 0u) {
        light = between(there);
    } else {
        light = light_at(at);
        if (places > 1) {
            light = mean(pixel, light);
        }
    }
    float exposure = HALF_CODE / tone_step(128u);
    uint red = code(light.r, exposure);
    uint green = red;
    uint blue = red;
    if (!GREY) {
        green = code(light.g, exposure);
        blue = code(light.b, exposure);
    }
    uint low = swaps != 0u ? blue : red;
    uint high = swaps != 0u ? red : blue;
    uint texel = low | green << 8 | high << 16 | 0xff000000u;
    imageStore(picture, pixel, uvec4(texel));
}
