//! `interplay predict`

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::Args;
use interplay_presentation::report;
use interplay_recordings::{Recordings, RecordingsError, compare};

use crate::flag_values::values::count;
use crate::output::error::ExitStatus;
use crate::output::{ending, json, print, print_error, print_load_error};

/// Say how well drivers predict recorded cars, from each second 1 to 5 s ahead.
///
/// Constant velocity, decaying acceleration, IDM and our human driver are compared. Models with parameters are fitted on one half of the
/// cars and judged on the other. A prediction knows nothing that was recorded after its start, and no vehicle's plan. Each argument is
/// a group of its own in the tables.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    interplay predict recordings/\n  \
    interplay predict us101/ munich/ --json\n  \
    interplay predict USA_US101-4_1_T-1.xml --starts 200")]
pub(crate) struct Predict {
    /// Scenarios of CommonRoad with recorded vehicles (.xml), tables of recorded vehicles (.csv), or folders of them
    #[arg(value_name = "RECORDINGS", required = true)]
    recordings: Vec<PathBuf>,

    /// Judge on at most N starts, evenly from all of them [default: all]
    #[arg(long, value_name = "N", value_parser = count::<NonZeroUsize>)]
    starts: Option<NonZeroUsize>,

    /// Print the measures as one JSON document
    #[arg(long)]
    json: bool,
}

impl Predict {
    pub(crate) fn execute(self) -> ExitStatus {
        let read = Recordings::read(&self.recordings);
        let compared = read.and_then(|recordings| {
            let [tracks, cars] = recordings.vehicles();
            let [rows, repeated] = recordings.rows();
            let share = 100.0 * repeated as f64 / rows.max(1) as f64;
            print_error(&format!(
                "{} files, {tracks} vehicles ({cars} different ones), {rows} rows, of which {share:.0} % repeat others",
                recordings.files()
            ));
            compare(&recordings, self.starts.map_or(usize::MAX, NonZeroUsize::get))
        });
        let comparison = match compared {
            Ok(comparison) => comparison,
            Err(error) => return refused(error),
        };
        let text = if self.json { json("the measures", &comparison) } else { Ok(report::prediction(&comparison)) };
        ending(text.and_then(|text| print(&text)))
    }
}

/// Says why recordings give no result.
pub(crate) fn refused(error: RecordingsError) -> ExitStatus {
    match error {
        RecordingsError::Refused(error) => print_load_error(*error),
        error => print_error(&format!("Error: {error}")),
    }
    ExitStatus::BadInput
}
