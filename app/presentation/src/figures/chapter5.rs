//! Chapter 5: zones that plan together.

use super::entry::{Entry, Kind};
use super::recorded_run::RunSpec;
use super::{climate, drawings};

const TOGETHER: RunSpec = RunSpec { label: "distributed", scenario: "building/distributed", sets: &[] };
const CENTRAL: RunSpec = RunSpec {
    label: "the same in one problem",
    scenario: "building/distributed",
    sets: &["controller={ kind = \"centralised\" }"],
};
const ROUNDS: RunSpec =
    RunSpec { label: "rounds as printed (Jacobi)", scenario: "building/distributed-rounds", sets: &[] };
const MOMENTUM: RunSpec = RunSpec {
    label: "rounds with momentum",
    scenario: "building/distributed-rounds",
    sets: &["controller.scheme=\"momentum\""],
};

/// The figures of the chapter.
pub(super) static ENTRIES: &[Entry] = &[
    Entry {
        kind: Kind::Figure,
        number: "5.1",
        title: "Temperatures of the four zones over three days",
        says: "After the first day all zones follow what is wanted between 8 and 19 h, and are cooled beforehand.",
        erratum: Some(
            "The matrix that couples the zones in (5.1) is the identity plus the Laplacian of the graph; read as an \
             adjacency matrix with ones it has a negative eigenvalue, and any uniform gain diverges.",
        ),
        runs: &[TOGETHER],
        beside: &[CENTRAL],
        draw: drawings::temperatures,
    },
    Entry {
        kind: Kind::Figure,
        number: "5.2",
        title: "Inputs of the four zones over three days",
        says: "Inputs obey their limits, are nearly zero outside working hours, and begin some steps before 8 h.",
        erratum: None,
        runs: &[TOGETHER],
        beside: &[CENTRAL],
        draw: drawings::inputs,
    },
    Entry {
        kind: Kind::Figure,
        number: "5.3",
        title: "Cost over the rounds of one exchange",
        says: "With every round k^c of messages the cost of the common plan falls, until the zones agree. A day takes 8 s, \
               and 10 s in one problem.",
        erratum: Some(
            "Theorem I promises descent, not the optimum: with u_ff of each zone as its unknown, as printed, the rounds \
             stall 2 to 76 % above it when inputs saturate. With the inputs themselves as unknowns they approach it; with \
             momentum in an eighth of the rounds. That one problem grows exponentially is a property of the dense form: in \
             the sparse one it is the faster of both at every size.",
        ),
        runs: &[ROUNDS],
        beside: &[MOMENTUM],
        draw: |entry, recorded_runs| Ok(climate::rounds(entry.title, recorded_runs[0]).drawing().into()),
    },
];
