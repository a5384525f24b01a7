//! What a driver senses of the other vehicles, and what it believes about their drivers.

pub mod belief;
pub mod sensing;
