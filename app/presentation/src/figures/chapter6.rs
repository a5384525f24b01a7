//! Chapter 6: negotiation.

use super::drawings::{footprints, footprints_and_planner_panels, speeds};
use super::entry::{Entry, Kind};
use super::recorded_run::RunSpec;
use super::theory;

const CONSERVATIVE: &[&str] = &["vehicle.ego.driver.kind=\"conservative\""];

const fn spec(scenario: &'static str) -> RunSpec {
    RunSpec { label: "negotiation", scenario, sets: &[] }
}

const fn beside(scenario: &'static str) -> RunSpec {
    RunSpec { label: "conservative planner instead", scenario, sets: CONSERVATIVE }
}

const PINNED: &str = "(6.15) demands safety from the other's old prediction, with which the best proposal is no proposal; \
    here it is demanded from the trajectory that is proposed. (6.19) is 0/0 when nothing changes; acceptance is then 1.";
const SWITCH: &str = "The rule for turning to the next driver, that acceptance rises no more for five steps, also fires when \
    everything is accepted; here acceptance must be below ½ as well.";
const FILTER: &str = "Nothing in the source keeps the ego from relying on a driver who does not yield. Here an input is \
    applied only if a conservative plan remains possible after it; each time that it is not, the run says so.";

/// The figures and tables of the chapter.
pub(super) static ENTRIES: &[Entry] = &[
    Entry {
        kind: Kind::Figure,
        number: "6.1",
        title: "Negotiation, lane change, drivers nice",
        says: "The ego (yellow) proposes, the front driver (blue) accepts and lets it cut in.",
        erratum: Some(PINNED),
        runs: &[spec("lane-change/front-nice")],
        beside: &[beside("lane-change/front-nice")],
        draw: footprints_and_planner_panels,
    },
    Entry {
        kind: Kind::Figure,
        number: "6.2",
        title: "Negotiation, lane change, front driver tough",
        says: "The ego tries to cut in ahead of the front driver, who refuses; it waits, asks the rear driver (green), who is \
               nice, and cuts in ahead of that one.",
        erratum: Some(SWITCH),
        runs: &[spec("lane-change/front-tough")],
        beside: &[beside("lane-change/front-tough")],
        draw: footprints_and_planner_panels,
    },
    Entry {
        kind: Kind::Figure,
        number: "6.3",
        title: "Negotiation, lane keeping, merging driver nice",
        says: "Someone wants to merge into the ego's lane; the ego accelerates and thereby says that it will not yield.",
        erratum: Some(PINNED),
        runs: &[spec("lane-keeping/nice")],
        beside: &[beside("lane-keeping/nice")],
        draw: footprints,
    },
    Entry {
        kind: Kind::Figure,
        number: "6.4",
        title: "Negotiation, lane keeping, merging driver tough",
        says: "The other merges whatever the ego does; the ego slows down and lets it in.",
        erratum: None,
        runs: &[spec("lane-keeping/tough")],
        beside: &[beside("lane-keeping/tough")],
        draw: footprints,
    },
    Entry {
        kind: Kind::Figure,
        number: "6.5",
        title: "Negotiation, lane keeping, speeds with a nice driver",
        says: "The ego is faster than the other throughout.",
        erratum: None,
        runs: &[spec("lane-keeping/nice")],
        beside: &[beside("lane-keeping/nice")],
        draw: speeds,
    },
    Entry {
        kind: Kind::Figure,
        number: "6.6",
        title: "Negotiation, lane keeping, speeds with a tough driver",
        says: "The ego slows down, then follows.",
        erratum: None,
        runs: &[spec("lane-keeping/tough")],
        beside: &[beside("lane-keeping/tough")],
        draw: speeds,
    },
    Entry {
        kind: Kind::Figure,
        number: "6.7",
        title: "Negotiation, intersection, crossing driver nice",
        says: "Both would arrive at once; the ego crosses first.",
        erratum: Some(FILTER),
        runs: &[spec("intersection/nice")],
        beside: &[beside("intersection/nice")],
        draw: footprints,
    },
    Entry {
        kind: Kind::Figure,
        number: "6.8",
        title: "Negotiation, intersection, crossing driver tough",
        says: "The ego waits and crosses second.",
        erratum: Some(FILTER),
        runs: &[spec("intersection/tough")],
        beside: &[beside("intersection/tough")],
        draw: footprints,
    },
    Entry {
        kind: Kind::Figure,
        number: "6.9",
        title: "Negotiation, intersection, speeds with a nice driver",
        says: "The ego accelerates and passes first; the other slows down.",
        erratum: None,
        runs: &[spec("intersection/nice")],
        beside: &[beside("intersection/nice")],
        draw: speeds,
    },
    Entry {
        kind: Kind::Figure,
        number: "6.10",
        title: "Negotiation, intersection, speeds with a tough driver",
        says: "The ego keeps its speed low until the other has passed.",
        erratum: None,
        runs: &[spec("intersection/tough")],
        beside: &[beside("intersection/tough")],
        draw: speeds,
    },
    Entry {
        kind: Kind::Table,
        number: "6.1",
        title: "Dimensions",
        says: "Vehicles and lanes at a tenth of their size.",
        erratum: None,
        runs: &[],
        beside: &[],
        draw: |entry, _| Ok(theory::dimensions(entry.title)),
    },
    Entry {
        kind: Kind::Table,
        number: "6.2",
        title: "Configuration of the optimisation",
        says: "Step, horizon, bounds of inputs, speed and lateral position, and the axes of the safety ellipse.",
        erratum: Some(
            "Beside another vehicle in the next lane the ellipse is passed at 1.057 times its half axis: just legal. At \
             intersections here the ellipse is wider (0.5 m), since 0.35 m leave 4.5 cm between a nose and a side.",
        ),
        runs: &[],
        beside: &[],
        draw: |entry, _| theory::configuration(entry.title),
    },
];
