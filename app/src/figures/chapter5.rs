//! Chapter 5: zones that plan together.

use super::{Entry, Kind, Shot, climate};

const TOGETHER: Shot = Shot {
    label: "distributed",
    scenario: "building/four-room-ilc",
    sets: &[
        "controller.kind=\"distributed\"",
        "iterations=3",
        "setpoints={ occupied_c = [22.5, 22.0, 23.0, 23.5], occupied_weight = 2.0 }",
    ],
};
const CENTRAL: Shot = Shot {
    label: "the same in one problem",
    scenario: "building/four-room-ilc",
    sets: &[
        "controller.kind=\"centralised\"",
        "iterations=3",
        "setpoints={ occupied_c = [22.5, 22.0, 23.0, 23.5], occupied_weight = 2.0 }",
    ],
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
        shots: &[TOGETHER],
        beside: &[CENTRAL],
        draw: |entry, takes| {
            Ok(climate::temperatures(entry.title, takes[0], &climate::first_zones(takes[0])).sketch().into())
        },
    },
    Entry {
        kind: Kind::Figure,
        number: "5.2",
        title: "Inputs of the four zones over three days",
        says: "Inputs obey their limits, are nearly zero outside working hours, and begin some steps before 8 h.",
        erratum: None,
        shots: &[TOGETHER],
        beside: &[CENTRAL],
        draw: |entry, takes| {
            Ok(climate::inputs(entry.title, takes[0], &climate::first_zones(takes[0])).sketch().into())
        },
    },
];
