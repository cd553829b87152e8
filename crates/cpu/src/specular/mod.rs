pub mod gloss_exit;
pub mod gloss_gather;
pub mod gloss_seen;
pub mod sun_gloss;
