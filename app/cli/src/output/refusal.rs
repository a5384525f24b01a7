//! Prints why a command ends without a result.

use interplay_sweep::SweepError;

use crate::output::exit_status::ExitStatus;
use crate::output::{print_error, print_load_error};
use crate::run_outputs::OutputError;

/// Prints why a command has no result.
pub(crate) fn gave_up(error: SweepError) -> ExitStatus {
    let ending = if error.is_bad_input() { ExitStatus::BadInput } else { ExitStatus::Unfinished };
    match error {
        SweepError::Refused(refusal) => print_load_error(*refusal),
        other => print_error(&other.to_string()),
    }
    ending
}

/// Says why an output of a run cannot be written.
pub(crate) fn unwritten(error: OutputError) -> ExitStatus {
    match error {
        OutputError::Refused(refusal) => {
            print_load_error(*refusal);
            ExitStatus::BadInput
        }
        OutputError::Table(error) => gave_up(error.into()),
        other => {
            print_error(&other.to_string());
            ExitStatus::Unfinished
        }
    }
}
