// Of the passes that march over the field's own heights, cell by cell.
layout(push_constant) uniform MarchPush {
    int lanes;
    int steps;
    int warm_up;  // steps marched beyond the field: whole periods, or 0
    uint first_azimuth;
};

#include "shared/heights.glsl"
