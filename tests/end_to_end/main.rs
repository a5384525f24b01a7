//! End-to-end tests, through the binary and through the library. Each module is one idea.
//!
//! - what a user sees: [`authored`], [`bad_input`], [`output`], [`recordings`], [`suite`], [`figures`], [`documents`]
//! - what must hold in every run: [`laws`], [`replay`], [`measures`], [`collisions`], [`failures`]
//! - buildings, in all of these respects: [`building`]
//! - the same again: [`determinism`] (golden digests in `golden/`; `INTERPLAY_BLESS=1` renews them)
//! - how the workspace is built: [`house`]

mod authored;
mod bad_input;
mod building;
mod collisions;
mod command;
mod determinism;
mod documents;
mod failures;
mod figures;
mod film;
mod house;
mod laws;
mod measures;
mod output;
mod recordings;
mod rectangles;
mod replay;
mod suite;
