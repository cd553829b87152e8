pub(crate) mod gloss_exit;
pub(crate) mod gloss_gather;
pub(crate) mod gloss_seen;
pub(crate) mod glossy;
pub(crate) mod sun_gloss;
