// Visibility of a cell's two flat triangles, one word per layer: 0 is north-east of the diagonal, 1 south-west. Bit
// 2j + k: triangle k has a free view along direction FACET_DIRECTIONS · layer + j.

const int FACET_DIRECTIONS = 15;      // per layer
const uint FACET_LOST = 0x80000000u;  // a ray exceeded the step limit
