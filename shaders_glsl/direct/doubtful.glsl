// Grid points of which shadow_shade cannot prove that they see all of a sun, for shadow_settle: the four lowest bits of one
// word for four grid points side by side along the lane axis, at [march position][lane / 4].
