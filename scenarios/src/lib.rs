//! Interplay: scenarios.
