//! What a caller is told while an identification goes on.

/// What is told while an identification goes on: a few words on what is fitted next, from any thread.
pub type Progress<'a> = dyn Fn(&str) + Sync + 'a;
