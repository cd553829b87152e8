#extension GL_EXT_samplerless_texture_functions : require

// World: right-handed, x east = increasing column, y north = decreasing row, z up.
// Grid point (row r, column c) is at x = c * cell.x, y = (rows - 1 - r) * cell.y, z = height.
// Surface: two flat triangles a cell, split from (r, c) to (r + 1, c + 1).
// Azimuth phi: radians, counter-clockwise from east. Elevation omega: up from horizontal.
// Slopes are tangents of elevations: rise over horizontal world distance.
//
// A sweep marches towards the receiver along the field axis nearest to its azimuth (the march axis); lines lie side
// by side along the other (the lane axis). Both axes are flipped where needed, so that march steps count up away from
// the horizon's side and lane positions grow with the shear. Lane positions are integers in 1/32768 of a cell, so
// that a line is exactly straight however long: line l is at  y = (l - lead) * spacing + step * shear  at a march
// step. Its steps lie on grid lines, where the surface is exactly the linear interpolation of two neighbouring grid
// points.

const float PI = 3.14159265358979;
const float HALF_PI = 1.57079632679490;

// Below every slope of a field, and safe to square.
const float NO_SLOPE = -1e9;
// Values at or below it mean "no horizon".
const float LOWEST_MET = -1e8;

const int CELL_SHIFT = 15;
const int CELL = 1 << CELL_SHIFT;

const uint BORDER_PLANE = 0u;
const uint BORDER_OPEN = 1u;
const uint BORDER_PERIODIC = 2u;

const uint AZIMUTH_MARCHES_ROWS = 1u;
const uint AZIMUTH_FLIPS_MARCH = 2u;
const uint AZIMUTH_FLIPS_LANES = 4u;

// One direction of a sweep and its weights.
struct Azimuth {
    float cos_phi;    // direction swept: the wedge's centre, but for exact azimuths
    float sin_phi;
    float wedge_cos;  // integral of cos over the wedge
    float wedge_sin;  // integral of sin over the wedge
    float wedge_rad;  // width of the wedge
    float step_m;     // world length of one march step
    int shear;        // lane advance of a step, in 1/32768 of a cell, 0 .. 32768
    uint layer;       // first layer of its result in the lattice
    uint flags;       // AZIMUTH_*
    float centre_rad; // azimuth of the wedge's centre, -pi .. pi
    float low_slope;  // sun: the disc's chord in this azimuth; key light: its elevations
    float high_slope;
    float weight;     // sun: radiance that makes the chords add up to irradiance 1; key light: 1
    int vector_march; // exact azimuths only: the grid vector (march, lane), both 0 or more, coprime
    int vector_lane;
    uint horizon_layer; // the layer of horizon_angles that it writes
};

Azimuth azimuth_from(vec4 a, vec4 b, vec4 c, vec4 d) {
    return Azimuth(a.x, a.y, a.z, a.w, b.x, b.y, floatBitsToInt(b.z), floatBitsToUint(b.w), floatBitsToUint(c.x),
                   c.y, c.z, c.w, d.x, floatBitsToInt(d.y), floatBitsToInt(d.z), floatBitsToUint(d.w));
}

// Entry k of a list of azimuths: four texels each, in the order above.
Azimuth azimuth_at(textureBuffer azimuths, uint k) {
    return azimuth_from(texelFetch(azimuths, int(4u * k)), texelFetch(azimuths, int(4u * k + 1u)),
                        texelFetch(azimuths, int(4u * k + 2u)), texelFetch(azimuths, int(4u * k + 3u)));
}
