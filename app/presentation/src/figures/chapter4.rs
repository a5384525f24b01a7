//! Chapter 4: feedforward and a Youla-parametrised feedback, designed at once.

use interplay_building::comfort::Setpoints;

use super::entry::{Entry, FigureContent, Kind};
use super::error::FigureError;
use super::recorded_run::{RecordedRun, RunSpec};
use super::{climate, theory};

const fn spec(label: &'static str, scenario: &'static str) -> RunSpec {
    RunSpec { label, scenario, sets: &[] }
}

const ACCURATE: RunSpec = spec("concurrent, exact prediction", "building/concurrent-exact");
const FIXED_ACCURATE: RunSpec = spec("fixed PID and learning, no forecast", "building/pid-exact");
const FORECAST: RunSpec = RunSpec {
    label: "planned with the forecast, fixed feedback",
    scenario: "building/concurrent-exact",
    sets: &["controller={ kind = \"iterative\", stability = \"fixed\" }"],
};
const UNCERTAIN: RunSpec = spec("concurrent, uncertain prediction", "building/concurrent-uncertain");
const FIXED_UNCERTAIN: RunSpec = spec("fixed PID and learning, no forecast", "building/pid-uncertain");

const BLIND: &str = "The vector α of (4.11) is blind to a Q that moves heat between rooms, and as printed Q does not enter the \
    cost at all: the Q that comes out can be far worse than none. Here Q minimises the effect of the disturbance that is \
    left, with bounds by rows and in the Frobenius norm, and comfort bounds are soft.";
const SAME: &str = "With an exact prediction, feedback has nothing left to do: inputs that are planned with the forecast do as \
    well with a fixed feedback as in the concurrent design. The gap between Figs. 4.5 and 4.6 needs a learner that is given \
    no forecast, which is what is drawn here.";

/// The first two rooms, as the source draws them.
fn two_rooms(entry: &Entry, recorded_runs: &[&RecordedRun]) -> Result<FigureContent, FigureError> {
    Ok(climate::temperatures(entry.title, recorded_runs[0], &[0, 1]).drawing().into())
}

/// The figures and tables of the chapter.
pub(super) static ENTRIES: &[Entry] = &[
    Entry {
        kind: Kind::Figure,
        number: "4.4",
        title: "Net disturbance of a day, predicted and real",
        says: "The net effect of weather and people on a room, as a temperature: prediction and reality differ clearly.",
        erratum: Some(
            "What is drawn is the outdoor temperature that would have the same effect, T₀ + w R₀: the source does not say \
             how it adds watts and degrees.",
        ),
        runs: &[UNCERTAIN],
        beside: &[],
        draw: |entry, recorded_runs| {
            Ok(climate::disturbance(entry.title, recorded_runs[0], &climate::first_zones(recorded_runs[0]))
                .drawing()
                .into())
        },
    },
    Entry {
        kind: Kind::Figure,
        number: "4.5",
        title: "Concurrent design, exact prediction",
        says: "Rooms 1 and 2 on three consecutive days: poor on the first, close to what is wanted from the second on, with \
               cooling that begins before people come.",
        erratum: Some(BLIND),
        runs: &[ACCURATE],
        beside: &[FIXED_ACCURATE],
        draw: two_rooms,
    },
    Entry {
        kind: Kind::Figure,
        number: "4.6",
        title: "Learning with a fixed PID feedback, exact prediction",
        says: "With a fixed feedback the part of the disturbance that does not repeat stays visible.",
        erratum: Some(SAME),
        runs: &[FIXED_ACCURATE],
        beside: &[FORECAST, ACCURATE],
        draw: two_rooms,
    },
    Entry {
        kind: Kind::Figure,
        number: "4.7",
        title: "Concurrent design, uncertain prediction",
        says: "With a prediction that errs, the rooms still follow closely and stay within the comfort zone.",
        erratum: Some(BLIND),
        runs: &[UNCERTAIN],
        beside: &[FIXED_UNCERTAIN],
        draw: two_rooms,
    },
    Entry {
        kind: Kind::Figure,
        number: "4.8",
        title: "Learning with a fixed PID feedback, uncertain prediction",
        says: "The fixed feedback does not follow well enough, and the comfort zone is left.",
        erratum: None,
        runs: &[FIXED_UNCERTAIN],
        beside: &[UNCERTAIN],
        draw: two_rooms,
    },
    Entry {
        kind: Kind::Table,
        number: "4.1",
        title: "Wanted temperatures during working hours",
        says: "22.5, 22, 23 and 23.5 °C in rooms 1 to 4 from 7:30 to 18 h; free otherwise.",
        erratum: None,
        runs: &[UNCERTAIN],
        beside: &[],
        draw: |entry, recorded_runs| {
            let default = Setpoints::default();
            Ok(theory::setpoints(entry.title, recorded_runs[0].scenario.setpoints.as_ref().unwrap_or(&default)))
        },
    },
];
