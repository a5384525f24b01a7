//! End-to-end tests, through the binary and through the library. Each module is one idea.
//!
//! - what a user sees: [`authored`], [`replacements`], [`bad_input`], [`output`], [`recordings`], [`suite`],
//!   [`figures`], [`animations`], [`authoring`], [`documents`], [`gallery`], [`book`], [`drift`], [`limits`]
//! - many runs from one plan: [`sweeps`]; what vehicles did as tables: [`trajectories`]; as scenarios of others: [`exports`]
//! - a user's files, terminal and server stay unharmed: [`unharmed`], [`faults`]
//! - what must hold in every run: [`laws`], [`replay`], [`measures`], [`traffic`], [`collisions`], [`failures`], [`fork`], [`played`]
//! - what would have happened: [`counterfactuals`], [`mutation`]
//! - what others may add: [`own`]
//! - what tyres, friction and lag make of it: [`plants`]
//! - vehicles that were recorded, scenarios of others, and maps far from the origin: [`recorded`]
//! - how recorded cars are predicted, and drivers fitted to them: [`predictions`]
//! - what scenarios demand of drivers: [`unsuited`]
//! - buildings, in all of these respects: [`building`]; controllers that learn: [`learning`]; telemetry: [`identified_houses`],
//!   [`sample_telemetry`]; buildings that are other programs: [`foreign_plants`],
//!   and for other programs: [`fmu`]
//! - the same again: [`determinism`] (golden digests in `golden/`; `INTERPLAY_BLESS=1` renews them)
//! - how the workspace is built: [`architecture`], [`modules`], [`lines`]; how it is written: [`plain_words`]; what its packages say: [`packages`], [`python_package`]

mod animations;
mod architecture;
mod authored;
mod authoring;
mod bad_input;
mod book;
mod building;
mod collisions;
mod command;
mod conduct;
mod counterfactuals;
mod determinism;
mod documents;
mod drift;
mod exports;
mod failures;
mod faults;
mod figures;
mod film;
mod fmu;
mod foreign_plants;
mod fork;
mod gallery;
mod identified_houses;
mod laws;
mod learning;
mod limits;
mod lines;
mod measures;
mod modules;
mod mutation;
mod output;
mod own;
mod packages;
mod plain_words;
mod plants;
mod played;
mod predictions;
mod python_package;
mod recorded;
mod recordings;
mod rectangles;
mod replacements;
mod replay;
mod sample_telemetry;
mod similarity;
mod street_contents;
mod streets;
mod suite;
mod sweep_plans;
mod sweeps;
mod traffic;
mod trajectories;
mod unharmed;
mod unit_plants;
mod unsuited;
