//! End-to-end tests, through the binary and through the library. Each module is one idea.
//!
//! - what a user sees: [`authored`], [`replacements`], [`bad_input`], [`output`], [`recordings`], [`suite`],
//!   [`figures`], [`animations`], [`authoring`], [`documents`], [`gallery`], [`book`], [`drift`], [`limits`]
//! - many runs from one plan: [`sweeps`]; runs as tables: [`trajectories`]; runs as CommonRoad
//!   scenarios: [`exports`]
//! - a user's files, terminal and server stay unharmed: [`unharmed`], [`faults`]
//! - laws of every run: [`laws`], [`replay`], [`measures`], [`traffic`], [`collisions`], [`failures`], [`fork`],
//!   [`causality`], [`seen_streets`], [`next_street`], [`every_street`], [`long_vehicles`]
//! - changes of a scenario: [`counterfactuals`], [`mutation`]
//! - extensions by users: [`own`]
//! - plants with tyres, friction and lag: [`plants`]
//! - recorded vehicles, imported scenarios, and maps far from the origin: [`recorded`]
//! - predictions of recorded cars, and drivers fitted to them: [`predictions`]
//! - buildings: [`building`]; controllers that learn: [`learning`]; telemetry: [`identified_houses`];
//!   buildings simulated by other programs: [`foreign_plants`]; buildings exported to other programs: [`fmu`]
//! - bit-identical repetition: [`determinism`] (golden digests in `golden/`; `INTERPLAY_BLESS=1` renews them)
//! - the workspace: [`architecture`], [`modules`], [`lines`]; its language: [`plain_words`]; its packages: [`packages`],
//!   [`python_package`]

mod animations;
mod architecture;
mod authored;
mod authoring;
mod bad_input;
mod book;
mod building;
mod causality;
mod collisions;
mod command;
mod conduct;
mod counterfactuals;
mod determinism;
mod documents;
mod drift;
mod every_street;
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
mod joins;
mod laws;
mod learning;
mod limits;
mod lines;
mod long_vehicles;
mod measures;
mod modules;
mod mutation;
mod next_street;
mod output;
mod own;
mod packages;
mod plain_words;
mod plants;
mod predictions;
mod python_package;
mod recorded;
mod recordings;
mod replacements;
mod replay;
mod seen_streets;
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
