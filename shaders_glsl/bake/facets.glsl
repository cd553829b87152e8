// A cell's two flat triangles, 0 north-east of its diagonal and 1 south-west of it, in a word a layer: bit 2j + k says whether
// triangle k sees the sky along direction FACET_DIRECTIONS · layer + j.

const int FACET_DIRECTIONS = 15;      // of a layer
const uint FACET_LOST = 0x80000000u;  // a ray took more steps than there can be
