//! Chapter 7: Bayesian persuasion.

use super::drawings::{footprints, footprints_and_planner_panels, speeds};
use super::entry::{Entry, Kind};
use super::recorded_run::RunSpec;

const fn spec(scenario: &'static str) -> RunSpec {
    RunSpec { label: "Bayesian persuasion", scenario, sets: &[] }
}

const fn conservative(scenario: &'static str) -> RunSpec {
    RunSpec { label: "conservative planner instead", scenario, sets: &["vehicle.ego.driver.kind=\"conservative\""] }
}

const fn exact(scenario: &'static str) -> RunSpec {
    RunSpec { label: "with the exact value of (7.19)", scenario, sets: &["vehicle.ego.driver.value=\"exact\""] }
}

const DROPPED: &str = "(7.19) silently drops a term. The value that follows from the chapter's own equations repels: with it \
    the ego stops and goes last (last row of the table). What is printed attracts, the more the readier the other seems \
    to change its plan; it is kept, as a choice of model. (7.16) lacks a square, and (7.21) needs a maximum where the text \
    takes a minimum.";

const NO_LINE: &str = "Nothing in the formulation holds the ego at a line: with these weights it slows down and times its \
    arrival behind the other, without coming to a stop.";

/// The figures of the chapter.
pub(super) static ENTRIES: &[Entry] = &[
    Entry {
        kind: Kind::Figure,
        number: "7.1",
        title: "Bayesian persuasion, lane change, rear driver nice",
        says: "The front driver (blue) is always tough. The rear driver (green) slows down and lets the ego (yellow) in.",
        erratum: Some(DROPPED),
        runs: &[spec("lane-change/bayesian-front-tough")],
        beside: &[conservative("lane-change/bayesian-front-tough"), exact("lane-change/bayesian-front-tough")],
        draw: footprints_and_planner_panels,
    },
    Entry {
        kind: Kind::Figure,
        number: "7.2",
        title: "Bayesian persuasion, lane change, rear driver tough",
        says: "The rear driver accelerates and ignores the ego, which waits until it has passed and changes lane behind it.",
        erratum: None,
        runs: &[spec("lane-change/bayesian-both-tough")],
        beside: &[conservative("lane-change/bayesian-both-tough")],
        draw: footprints_and_planner_panels,
    },
    Entry {
        kind: Kind::Figure,
        number: "7.3",
        title: "Bayesian persuasion, lane keeping, merging driver nice",
        says: "The ego does not let the merging driver in: it accelerates, to show its intention.",
        erratum: Some(DROPPED),
        runs: &[spec("lane-keeping/bayesian-nice")],
        beside: &[conservative("lane-keeping/bayesian-nice"), exact("lane-keeping/bayesian-nice")],
        draw: footprints,
    },
    Entry {
        kind: Kind::Figure,
        number: "7.4",
        title: "Bayesian persuasion, lane keeping, merging driver tough",
        says: "The ego slows down, to show that it yields.",
        erratum: None,
        runs: &[spec("lane-keeping/bayesian-tough")],
        beside: &[conservative("lane-keeping/bayesian-tough")],
        draw: footprints,
    },
    Entry {
        kind: Kind::Figure,
        number: "7.5",
        title: "Bayesian persuasion, lane keeping, speeds with a nice driver",
        says: "The ego accelerates and stays faster than the other.",
        erratum: None,
        runs: &[spec("lane-keeping/bayesian-nice")],
        beside: &[conservative("lane-keeping/bayesian-nice")],
        draw: speeds,
    },
    Entry {
        kind: Kind::Figure,
        number: "7.6",
        title: "Bayesian persuasion, lane keeping, speeds with a tough driver",
        says: "The ego slows down, then follows.",
        erratum: None,
        runs: &[spec("lane-keeping/bayesian-tough")],
        beside: &[conservative("lane-keeping/bayesian-tough")],
        draw: speeds,
    },
    Entry {
        kind: Kind::Figure,
        number: "7.7",
        title: "Bayesian persuasion, intersection, crossing driver nice",
        says: "The ego passes first.",
        erratum: Some(DROPPED),
        runs: &[spec("intersection/bayesian-nice")],
        beside: &[conservative("intersection/bayesian-nice"), exact("intersection/bayesian-nice")],
        draw: footprints,
    },
    Entry {
        kind: Kind::Figure,
        number: "7.8",
        title: "Bayesian persuasion, intersection, crossing driver tough",
        says: "The ego inches forward, then stops and waits for the other to pass.",
        erratum: Some(NO_LINE),
        runs: &[spec("intersection/bayesian-tough")],
        beside: &[conservative("intersection/bayesian-tough")],
        draw: footprints,
    },
    Entry {
        kind: Kind::Figure,
        number: "7.9",
        title: "Bayesian persuasion, intersection, speeds with a nice driver",
        says: "The ego keeps accelerating and crosses first.",
        erratum: None,
        runs: &[spec("intersection/bayesian-nice")],
        beside: &[conservative("intersection/bayesian-nice")],
        draw: speeds,
    },
    Entry {
        kind: Kind::Figure,
        number: "7.10",
        title: "Bayesian persuasion, intersection, speeds with a tough driver",
        says: "The ego inches, then stops.",
        erratum: Some(NO_LINE),
        runs: &[spec("intersection/bayesian-tough")],
        beside: &[conservative("intersection/bayesian-tough")],
        draw: speeds,
    },
];
