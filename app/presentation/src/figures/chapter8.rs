//! Chapter 8: the persuasion game.

use super::drawings::{footprints_and_planner_panels, speeds};
use super::entry::{Entry, Kind};
use super::recorded_run::RunSpec;
use super::theory;

const fn spec(scenario: &'static str) -> RunSpec {
    RunSpec { label: "game", scenario, sets: &[] }
}

const fn conservative(scenario: &'static str) -> RunSpec {
    RunSpec { label: "conservative planner instead", scenario, sets: &["vehicle.ego.driver.kind=\"conservative\""] }
}

const fn large(scenario: &'static str) -> RunSpec {
    RunSpec { label: "accident as printed, \"large\": M = 50", scenario, sets: &["vehicle.ego.driver.accident=50"] }
}

const fn nash(scenario: &'static str) -> RunSpec {
    RunSpec {
        label: "equilibrium instead of leader and follower",
        scenario,
        sets: &["vehicle.ego.driver.solution=\"nash\""],
    }
}

const LARGE: &str = "Probabilities are clipped to [0.05, 0.95], since (8.1) reaches exactly 1 and (8.12) then takes the \
    logarithm of 0. With that, stakes reach 19, and M is of their order here, 1 to 3. The printed \
    procedure (8.8), (8.9) is that of a leader and a follower, not a Nash equilibrium; both are offered.";
const SWAPPED: &str = "The bounds of (8.15) are swapped in print, so that the interval of speeds is empty; here the lower \
    one belongs to p_l and the upper one to p*. A denominator that is not positive bounds nothing on that side. With a \
    \"large\" M, as printed, the ego yields even to a friendly driver.";

/// The figures and tables of the chapter.
pub(super) static ENTRIES: &[Entry] = &[
    Entry {
        kind: Kind::Figure,
        number: "8.1",
        title: "How people weigh probabilities",
        says: "Small probabilities weigh more than they are, large ones less; for gains and losses with different exponents.",
        erratum: Some(
            "The exponents belong the other way round: 0.61 to gains and 0.69 to losses, as in Tversky and Kahneman, and δ \
             in print is η. \"β > 1\" contradicts the 0.88 that is used. In (8.7) outcomes must be ranked; \"any order\" is \
             not the same.",
        ),
        runs: &[],
        beside: &[],
        draw: |entry, _| Ok(theory::weights(entry.title)),
    },
    Entry {
        kind: Kind::Figure,
        number: "8.2",
        title: "Game, lane change, rear driver friendly",
        says: "The front driver never yields. The ego merges ahead of the friendly rear driver.",
        erratum: Some(LARGE),
        runs: &[spec("lane-change/game-friendly")],
        beside: &[
            conservative("lane-change/game-friendly"),
            nash("lane-change/game-friendly"),
            large("lane-change/game-friendly"),
        ],
        draw: footprints_and_planner_panels,
    },
    Entry {
        kind: Kind::Figure,
        number: "8.3",
        title: "Game, lane change, rear driver aggressive",
        says: "The ego finds no chance to merge until the second driver has passed too.",
        erratum: None,
        runs: &[spec("lane-change/game-aggressive")],
        beside: &[conservative("lane-change/game-aggressive"), nash("lane-change/game-aggressive")],
        draw: footprints_and_planner_panels,
    },
    Entry {
        kind: Kind::Figure,
        number: "8.4",
        title: "Game, lane change, speeds with a friendly driver",
        says: "The friendly driver slows down while the ego merges.",
        erratum: None,
        runs: &[spec("lane-change/game-friendly")],
        beside: &[conservative("lane-change/game-friendly")],
        draw: speeds,
    },
    Entry {
        kind: Kind::Figure,
        number: "8.5",
        title: "Game, lane change, speeds with an aggressive driver",
        says: "The ego slows down until both have passed.",
        erratum: None,
        runs: &[spec("lane-change/game-aggressive")],
        beside: &[conservative("lane-change/game-aggressive")],
        draw: speeds,
    },
    Entry {
        kind: Kind::Figure,
        number: "8.6",
        title: "Game, intersection, crossing driver friendly",
        says: "The other decides to yield, and the ego crosses first.",
        erratum: Some(SWAPPED),
        runs: &[spec("intersection/game-friendly")],
        beside: &[conservative("intersection/game-friendly"), large("intersection/game-friendly")],
        draw: footprints_and_planner_panels,
    },
    Entry {
        kind: Kind::Figure,
        number: "8.7",
        title: "Game, intersection, speeds with a friendly driver",
        says: "The ego accelerates, the other slows down.",
        erratum: None,
        runs: &[spec("intersection/game-friendly")],
        beside: &[conservative("intersection/game-friendly")],
        draw: speeds,
    },
    Entry {
        kind: Kind::Figure,
        number: "8.8",
        title: "Game, intersection, crossing driver aggressive",
        says: "The other passes first, and the ego has to wait.",
        erratum: Some(SWAPPED),
        runs: &[spec("intersection/game-aggressive")],
        beside: &[conservative("intersection/game-aggressive"), large("intersection/game-aggressive")],
        draw: footprints_and_planner_panels,
    },
    Entry {
        kind: Kind::Figure,
        number: "8.9",
        title: "Game, intersection, speeds with an aggressive driver",
        says: "The ego slows down until the other has passed.",
        erratum: None,
        runs: &[spec("intersection/game-aggressive")],
        beside: &[conservative("intersection/game-aggressive")],
        draw: speeds,
    },
    Entry {
        kind: Kind::Table,
        number: "8.1",
        title: "The game of chicken",
        says: "Who swerves while the other drives on is the chicken; if both drive on, both lose M.",
        erratum: None,
        runs: &[],
        beside: &[],
        draw: |entry, _| Ok(theory::chicken(entry.title)),
    },
    Entry {
        kind: Kind::Table,
        number: "8.2",
        title: "Payoffs of the driving game",
        says: "The same with stakes that depend on what each is believed to intend; x_s = p̃_s|e / p̃_e|s is that of the \
               surrounding vehicle (SV), x_e = p_e / p̃_s|e that of the ego (EV).",
        erratum: Some(
            "The first number of each pair is the surrounding vehicle's. With clipped probabilities a stake reaches 19, \
             more than a moderate M: then waiting for ever is worse than the accident.",
        ),
        runs: &[],
        beside: &[],
        draw: |entry, _| Ok(theory::payoffs(entry.title)),
    },
    Entry {
        kind: Kind::Table,
        number: "8.3",
        title: "Probabilities of the four events",
        says: "Products of the two probabilities of passing.",
        erratum: None,
        runs: &[],
        beside: &[],
        draw: |entry, _| Ok(theory::events(entry.title)),
    },
];
