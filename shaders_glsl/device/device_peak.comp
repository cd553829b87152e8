// Computes: work that one unit of the device limits, so that its time gives the peak rate of that unit.
// Reads: source (copy) or texels (fetch).
// Writes: result; "fill" writes source and filled, the image that texels reads.
// One invocation does `rounds` of the work of its part. Sums are of small integers and products by 1/2 are exact, so neither the
// order of a sum nor fused operations change a bit.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 64) in;

const int FILL = 0;    // writes every page, so that none share memory
const int COPY = 1;    // memory
const int FETCH = 2;   // texel fetches: neighbours in a row, a row a round
const int SHARED = 3;  // shared memory: 8 bytes a round, neighbours side by side
const int FMA = 4;     // eight independent multiplications and additions a round
layout(constant_id = 0) const int PART = FILL;

layout(binding = 0) buffer Source { vec4 source[]; };
layout(binding = 1) writeonly buffer Result { vec4 result[]; };
layout(binding = 2, r32f) uniform writeonly image2D filled;
layout(binding = 3) uniform texture2D texels;

layout(push_constant) uniform DevicePeakPush {
    int invocations;
    int rounds;
    int side;  // texels along each side of the image; a power of two
    float factor;
    float summand;
};

const int ENTRIES = 256;
shared vec2 entries[ENTRIES];

void main() {
    int i = int(gl_GlobalInvocationID.x);
    int local = int(gl_LocalInvocationIndex);
    if (PART == FILL) {
        for (int k = 0; k < rounds; k++) {
            source[i + k * invocations] = vec4(i & 1023, k, i & 255, 1.0);
        }
        // With fewer invocations than texels, each writes several.
        for (int texel = i; texel < side * side; texel += invocations) {
            imageStore(filled, ivec2(texel % side, texel / side), vec4(texel & 7));
        }
    } else if (PART == COPY) {
        for (int k = 0; k < rounds; k++) {
            result[i + k * invocations] = source[i + k * invocations];
        }
    } else if (PART == FETCH) {
        float sum = 0.0;
        for (int k = 0; k < rounds; k++) {
            sum += texelFetch(texels, ivec2(i & (side - 1), (i / side + k) & (side - 1)), 0).x;
        }
        result[i] = vec4(sum);
    } else if (PART == SHARED) {
        for (int entry = local; entry < ENTRIES; entry += 64) {
            entries[entry] = vec2(entry & 15, entry & 7);
        }
        barrier();
        vec2 sum = vec2(0.0);
        for (int k = 0; k < rounds; k++) {
            sum += entries[(local + k) & (ENTRIES - 1)];
        }
        result[i] = vec4(sum, sum);
    } else {
        vec4 a = vec4(i & 255, 1.0, 2.0, 3.0);
        vec4 b = a + 256.0;
        for (int k = 0; k < rounds; k++) {
            a = a * factor + summand;
            b = b * factor + summand;
        }
        result[i] = a + b;
    }
}
