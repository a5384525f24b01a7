//! Chapter 3: feedforward and feedback designed in turn.

use interplay_building::comfort::Setpoints;

use super::entry::{Entry, Kind};
use super::recorded_run::RunSpec;
use super::{climate, drawings, theory};

const TUNED: RunSpec =
    RunSpec { label: "feedback tuned every day", scenario: "building/iterative-warm-nights", sets: &[] };
const FIXED: RunSpec =
    RunSpec { label: "fixed feedback, K = 0.1 kW/K", scenario: "building/fixed-warm-nights", sets: &[] };
const PRINTED: RunSpec = RunSpec {
    label: "objective as printed: feedback left open",
    scenario: "building/iterative-warm-nights",
    sets: &["controller.objective=\"nominal\""],
};
const FREE_NIGHTS: RunSpec =
    RunSpec { label: "free at night: tuned feedback", scenario: "building/iterative-free-nights", sets: &[] };
const FIXED_FREE_NIGHTS: RunSpec =
    RunSpec { label: "free at night: fixed feedback", scenario: "building/fixed-free-nights", sets: &[] };

const DEGENERATE: &str = "As printed, the design multiplies all its unknowns by one known vector, so that only the nominal \
    inputs matter: given a forecast it learns nothing, and the feedback is whatever the solver happens to return. Here the \
    expected cost is minimised (which gives feedback a value), feedback is causal, and what the forecast keeps missing is \
    learned from day to day. The last row of the table has the objective as printed.";

/// The figures and tables of the chapter.
pub(super) static ENTRIES: &[Entry] = &[
    Entry {
        kind: Kind::Figure,
        number: "3.2",
        title: "Weather of five days, forecast and real",
        says: "Forecast and real outdoor temperatures in Singapore: most of a day repeats, and forecast and reality differ \
               by a degree or two.",
        erratum: Some(
            "The weather files of the source are not named. The climate here is synthetic, drawn from a seed, and has \
             Singapore's mean, range and scatter; the forecast errs as BOPTEST defines it.",
        ),
        runs: &[TUNED],
        beside: &[],
        draw: |entry, recorded_runs| Ok(climate::weather(entry.title, recorded_runs[0]).drawing().into()),
    },
    Entry {
        kind: Kind::Figure,
        number: "3.3",
        title: "Temperatures of the four rooms, day by day",
        says: "On the first day the rooms are far from what is wanted; from the second day on they follow it in spite of \
               weather that no forecast knew.",
        erratum: Some(DEGENERATE),
        runs: &[TUNED],
        beside: &[PRINTED],
        draw: drawings::temperatures,
    },
    Entry {
        kind: Kind::Figure,
        number: "3.4",
        title: "Inputs of the four rooms, day by day",
        says: "The inputs stay between their limits of ±2 on every day.",
        erratum: Some(
            "The limit is one of power, in kW. The chance constraint (3.21) bounds each input on its own with 95 %; all 192 \
             of a day hold together less often. What the equipment cannot give is cut off and counted below.",
        ),
        runs: &[TUNED],
        beside: &[],
        draw: drawings::inputs,
    },
    Entry {
        kind: Kind::Figure,
        number: "3.5",
        title: "Cost of each day, with tuned and with fixed feedback",
        says: "From the same start, both learn on the first day; with feedback that is tuned every day the cost settles \
               lower than with fixed feedback. A design takes about 120 s.",
        erratum: Some(DEGENERATE),
        runs: &[TUNED, FIXED],
        beside: &[FREE_NIGHTS, FIXED_FREE_NIGHTS, PRINTED],
        draw: |entry, recorded_runs| Ok(climate::costs(entry.title, recorded_runs).drawing().into()),
    },
    Entry {
        kind: Kind::Table,
        number: "3.1",
        title: "Wanted temperatures while occupied",
        says: "24, 25, 26 and 27 °C in rooms 1 to 4 from 8 to 19 h; 30 °C otherwise.",
        erratum: None,
        runs: &[TUNED],
        beside: &[],
        draw: |entry, recorded_runs| {
            let default = Setpoints::default();
            Ok(theory::setpoints(entry.title, recorded_runs[0].scenario.setpoints.as_ref().unwrap_or(&default)))
        },
    },
];
