//! Indirect light: bounce engines (brute force, sweep walks, pyramids), their nodes and their pyramids of exit radiance.
//! `bounces` plans them; the other files are one per pass.

/// `--bounce-engine pyramid`: what each texel gathers from pyramids of heights and of exit radiance.
pub(crate) mod bounce_gather;
/// `--bounce-engine sweep`: height and exit radiance of every texel, side by side.
pub(crate) mod bounce_ground;
/// `--bounce-engine brute-force`: every visible interval along each azimuth.
pub(crate) mod bounce_march;
pub(crate) mod bounce_nodes;
/// Bounces at nodes: the mean radiance that nodes gather, times each texel's own share of ground.
pub(crate) mod bounce_shade;
/// `--bounce-engine sweep`: visible ground up to each texel's horizon, near by step by step, farther away in blocks.
pub(crate) mod bounce_walk;
pub(crate) mod bounces;
/// Later bounces from the visibility cache.
pub(crate) mod cache_gather;
/// `--bounce-engine sweep`: heights and radiance of the ground along swept lines, block by block.
pub(crate) mod line_blocks;
/// `--bounce-engine pyramid`: for a stack, all levels of exit radiance at every grid point.
pub(crate) mod shade_expand;
/// `--bounce-engine pyramid`: each level of exit radiance from the next finer one.
pub(crate) mod shade_reduce;
/// What each texel gathers from the levels of radiance by direction.
pub(crate) mod specular_gather;
/// Levels of radiance by direction.
pub(crate) mod vector_reduce;
