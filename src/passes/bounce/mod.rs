//! Indirect light: bounce engines (brute force, sweep walks, pyramids), their nodes and their pyramids of exit radiance.
//! `bounces` plans them; the other files are one per pass.

pub(crate) mod bounce_gather;
pub(crate) mod bounce_march;
pub(crate) mod bounce_nodes;
pub(crate) mod bounce_shade;
pub(crate) mod bounce_walk;
pub(crate) mod bounces;
pub(crate) mod cache_gather;
pub(crate) mod shade_expand;
pub(crate) mod shade_reduce;
pub(crate) mod specular_gather;
pub(crate) mod vector_reduce;
