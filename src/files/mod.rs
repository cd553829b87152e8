//! Readers and writers, one a format. An output file is complete or absent.
