//! GLSL text with the basis' constants, for shaders that need a product of two series that both change from
//! place to place (local lights), and for slices.
