//! CPU references of the passes that compute indirect light of diffuse ground: pyramids of
//! exit radiance, the visibility cache, and the three gathering methods (pyramid, exact march, walk over line blocks).

pub mod bounce_gather;
pub mod bounce_ground;
pub mod bounce_march;
pub mod bounce_shade;
pub mod bounce_walk;
pub mod cache_gather;
pub mod line_blocks;
pub mod shade_expand;
pub mod shade_reduce;
pub mod specular_gather;
pub mod vector_reduce;
