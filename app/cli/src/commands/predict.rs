//! `interplay predict`

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::Args;
use interplay_presentation::report;
use interplay_recordings::{Recordings, RecordingsError, compare, leave_one_out};

use crate::flag_values::values::count;
use crate::output::error::ExitStatus;
use crate::output::{ending, json, print, print_error, print_load_error};

/// Say how well drivers predict recorded cars, from each second 1 to 5 s ahead.
///
/// Constant velocity, decaying acceleration, IDM, seen motion and our human driver are compared. Models with parameters are fitted on one half of the
/// cars and judged on the other. A prediction knows nothing that was recorded after its start, and no vehicle's plan. Each argument is
/// a group of its own in the tables.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    interplay predict recordings/\n  \
    interplay predict us101/ munich/ --json\n  \
    interplay predict us101/ lanker/ munich/ --leave-one-out --starts 300\n  \
    interplay predict USA_US101-4_1_T-1.xml --starts 200")]
pub(crate) struct Predict {
    /// Scenarios of CommonRoad with recorded vehicles (.xml), tables of recorded vehicles (.csv), or folders of them
    #[arg(value_name = "RECORDINGS", required = true)]
    recordings: Vec<PathBuf>,

    /// Say only how the recorded cars drive, and how far the driving in each argument is from that in the first
    #[arg(long, conflicts_with_all = ["leave_one_out", "starts"])]
    driving: bool,

    /// Judge on each argument what was fitted on all others; the last table is the pool
    #[arg(long)]
    leave_one_out: bool,

    /// Judge on at most N starts, evenly from all of them, or of each argument with --leave-one-out [default: all]
    #[arg(long, value_name = "N", value_parser = count::<NonZeroUsize>)]
    starts: Option<NonZeroUsize>,

    /// Print the measures as one JSON document
    #[arg(long)]
    json: bool,
}

impl Predict {
    pub(crate) fn execute(self) -> ExitStatus {
        let read = Recordings::read(&self.recordings);
        if self.driving {
            return match read {
                Ok(recordings) => self.driving(&recordings),
                Err(error) => refused(error),
            };
        }
        let compared = read.and_then(|recordings| {
            let [tracks, cars] = recordings.vehicles();
            let [rows, repeated] = recordings.rows();
            let share = 100.0 * repeated as f64 / rows.max(1) as f64;
            print_error(&format!(
                "{} files, {tracks} vehicles ({cars} different ones), {rows} rows, of which {share:.0} % repeat others",
                recordings.files()
            ));
            let most = self.starts.map_or(usize::MAX, NonZeroUsize::get);
            if self.leave_one_out { leave_one_out(&recordings, most) } else { compare(&recordings, most) }
        });
        let comparison = match compared {
            Ok(comparison) => comparison,
            Err(error) => return refused(error),
        };
        let text = if self.json { json("the measures", &comparison) } else { Ok(report::prediction(&comparison)) };
        ending(text.and_then(|text| print(&text)))
    }
}

impl Predict {
    /// Prints how the recorded cars of each group drive, and how far they are from those of the first.
    fn driving(&self, recordings: &Recordings) -> ExitStatus {
        let (driving, distances) = (recordings.driving(), recordings.driving_distances());
        let text = if self.json {
            json("the statistics", &serde_json::json!({ "driving": driving, "distances": distances }))
        } else {
            Ok(report::driving(&driving, &distances))
        };
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
