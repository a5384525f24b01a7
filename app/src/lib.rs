//! Interplay.
