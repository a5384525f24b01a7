//! Chapter 2: what the room is like, from its telemetry.

use super::entry::{Entry, Kind};
use super::theory;

/// The figures and tables of the chapter.
pub(super) static ENTRIES: &[Entry] = &[
    Entry {
        kind: Kind::Figure,
        number: "2.5",
        title: "Identified classroom, on the days it was trained on",
        says: "Temperatures of a classroom in Berkeley from 21 to 29 October, every 15 minutes, and what the \
               semi-parametric model makes of them after training on the same days: the two nearly coincide.",
        erratum: Some(
            "The measurements are not public; a synthetic classroom of the same size takes their place. The estimate \
             follows the corrected equations: the Hessian (2.10) lacks a square and a sign, with which Newton's method \
             diverges; smoothing the temperatures does not remove the disturbance unless the heat is smoothed too \
             (otherwise gains are 70 to 130 % off); the M-step (2.14) divides by a sum where a sum of squares belongs.",
        ),
        runs: &[],
        beside: &[],
        draw: |entry, _| theory::identification(entry.title, false),
    },
    Entry {
        kind: Kind::Figure,
        number: "2.6",
        title: "Identified classroom, on days it has not seen",
        says: "The same model on the days from 31 October to 17 November, which it was not trained on: prediction is as \
               good as before.",
        erratum: Some(
            "A prediction one step ahead says little, because temperatures hardly change within 15 minutes. Below it, \
             the model runs freely for a day at a time.",
        ),
        runs: &[],
        beside: &[],
        draw: |entry, _| theory::identification(entry.title, true),
    },
    Entry {
        kind: Kind::Table,
        number: "2.1",
        title: "Thermal parameters of the four-room testbed",
        says: "Capacities of 1000 kJ/K; resistances of 1.0417 kW/K between adjacent rooms, 10000 kW/K between the others, \
               and 0.5208 kW/K to the air outside.",
        erratum: Some(
            "The unit cannot be kW/K: with the step of half an hour that chapters 3 to 5 use, the rooms would then be \
             unstable. Read as K·min/kJ, which is 60 K/kW, they settle within hours, as rooms do.",
        ),
        runs: &[],
        beside: &[],
        draw: |entry, _| theory::thermal_parameters(entry.title),
    },
];
