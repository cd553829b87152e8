//! Error metrics and statistics.
