//! The shared library through its C functions, as an importer calls them, beside the network that it was made of.

mod house;
mod instances;
#[allow(unsafe_code, missing_docs, reason = "the functions of FMI take pointers of the importer")]
#[path = "../../library/lib.rs"]
mod library;
mod moves;
#[allow(unsafe_code, reason = "the functions of FMI take pointers")]
mod refusals;
mod states;
#[allow(unsafe_code, reason = "the functions of FMI take pointers")]
mod unit;
