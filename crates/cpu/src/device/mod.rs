//! CPU references of the passes that find a device's peak rates.

pub mod device_peak;
