pub mod indirect;
pub mod key;
pub mod light;
pub mod lit;
pub mod oracle;
pub mod path_trace;
pub mod profile;
pub mod sphere;
