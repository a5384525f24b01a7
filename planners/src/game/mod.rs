//! Persuasion game (chapter 8).
pub mod equilibrium;
pub mod payoff;
pub mod prospect;
pub mod reply;
