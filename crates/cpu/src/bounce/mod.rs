pub mod bounce_gather;
pub mod bounce_march;
pub mod bounce_shade;
pub mod bounce_walk;
pub mod cache_gather;
pub mod shade_expand;
pub mod shade_reduce;
pub mod vector_reduce;
