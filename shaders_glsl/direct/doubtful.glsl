// Grid points of which shadow_shade cannot prove that they see all of a sun, for shadow_settle: the four lowest bits of one
// word for four grid points side by side along the lane axis, at [march position][lane / 4].

// The words of a workgroup of shadow_settle: at march positions and fours of lanes.
const ivec2 SETTLE_WORDS = ivec2(16, 8);
