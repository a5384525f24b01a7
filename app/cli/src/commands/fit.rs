//! `interplay fit`

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use interplay_recordings::{FittedDriver, MeasureInterval, Recordings, RecordingsError, fit_driver};

use super::predict::refused;
use crate::output::error::ExitStatus;
use crate::output::{ending, json, print};

/// Fit the human driver model to recorded vehicles: time gap, comfort and style, with 95 % intervals.
///
/// The driver plans from each second with a vehicle ahead; its plans are compared with the record 1 to 3 s later.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    interplay fit USA_US101-4_1_T-1.xml --vehicle 468\n  \
    interplay fit trajectories.csv --vehicle ego --json")]
pub(crate) struct Fit {
    /// A scenario of CommonRoad with recorded vehicles (.xml), a table of recorded vehicles (.csv), or a folder of them
    #[arg(value_name = "RECORDING")]
    recording: PathBuf,

    /// The vehicle, by its id; may be repeated [default: all that follow another vehicle long enough]
    #[arg(long, value_name = "ID")]
    vehicle: Vec<String>,

    /// Print the drivers as one JSON document
    #[arg(long)]
    json: bool,
}

impl Fit {
    pub(crate) fn execute(self) -> ExitStatus {
        let fitted = match Recordings::read(std::slice::from_ref(&self.recording)).and_then(|read| self.fitted(&read)) {
            Ok(fitted) => fitted,
            Err(error) => return refused(error),
        };
        let text = if self.json { json("the drivers", &fitted) } else { Ok(text(&fitted)) };
        ending(text.and_then(|text| print(&text)))
    }

    fn fitted(&self, recordings: &Recordings) -> Result<Vec<FittedDriver>, RecordingsError> {
        if !self.vehicle.is_empty() {
            return self.vehicle.iter().map(|vehicle| fit_driver(recordings, vehicle)).collect();
        }
        let mut ids = recordings.vehicle_ids();
        ids.sort_unstable();
        ids.dedup();
        let found: Vec<FittedDriver> = ids.iter().filter_map(|id| fit_driver(recordings, id).ok()).collect();
        if found.is_empty() {
            let vehicle = ids.first().copied().unwrap_or_default();
            return fit_driver(recordings, vehicle).map(|driver| vec![driver]);
        }
        Ok(found)
    }
}

fn text(fitted: &[FittedDriver]) -> String {
    let mut text = String::new();
    for driver in fitted {
        let of = |it: MeasureInterval| format!("{:.2} [{:.2} to {:.2}]", it.value, it.low, it.high);
        // Writing to a text cannot fail.
        let _ = writeln!(
            text,
            "{}: {}\n  time gap beyond 3.5 m   {} s\n  acceleration_change     {} s⁴/m²\n  safety weight           {}\n  \
             wanted speed            {:.1} m/s\n  error after 3 s         {:.2} m ({:.2} m at constant velocity), {} starts",
            driver.vehicle,
            driver.style,
            of(driver.time_gap_s),
            of(driver.acceleration_change),
            of(driver.safety_weight),
            driver.wanted_mps,
            driver.along_rmse_m,
            driver.constant_velocity_rmse_m,
            driver.starts
        );
    }
    text
}
