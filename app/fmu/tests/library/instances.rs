//! Several instances in one process.

use std::thread;

use crate::house::{GUID, Resources, STEP_S, model, resources};
use crate::unit::{BOTH, Fmi, OK, Unit};

const STEPS: usize = 40;

/// Heat of both zones that differs from run to run \[kW\].
fn heat_kw(run: usize, step: usize) -> [f64; 2] {
    [(run as f64 + 1.0) * (step as f64).sin(), 0.3 * run as f64]
}

/// A step of a run, and the bits of both temperatures after it.
fn step(unit: &Unit, run: usize, step: usize) -> [u64; 2] {
    assert_eq!(unit.set(&[0, 1], &heat_kw(run, step)), OK);
    assert_eq!(unit.step(STEP_S * step as f64, STEP_S), OK);
    let temperatures_c = unit.get(&[2, 3]).1;
    [temperatures_c[0].to_bits(), temperatures_c[1].to_bits()]
}

/// A run without other instances in the process.
fn run_alone(fmi: Fmi, folder: &Resources, run: usize) -> Vec<[u64; 2]> {
    let unit = Unit::new(fmi, folder.path(), GUID).expect("an instance");
    assert_eq!(unit.begin(0.0), OK);
    (0..STEPS).map(|at| step(&unit, run, at)).collect()
}

#[test]
fn instances_that_take_turns_do_not_change_each_other() {
    let folder = Resources::write("turns", &resources(&model(), STEPS));
    let expected: Vec<_> = (0..3).map(|run| run_alone(Fmi::Two, &folder, run)).collect();
    assert!(expected[0] != expected[1] && expected[1] != expected[2]);
    for fmi in BOTH {
        // The third begins when the others are halfway, in the other version, and the first is freed before they end.
        let other = if fmi == Fmi::Two { Fmi::Three } else { Fmi::Two };
        let mut units: Vec<Option<Unit>> =
            [fmi, fmi, other].map(|fmi| Unit::new(fmi, folder.path(), GUID).ok()).into_iter().collect();
        assert!(units.iter().flatten().all(|unit| unit.begin(0.0) == OK));
        for turn in 0..STEPS + STEPS / 2 {
            if turn == STEPS {
                units[0] = None;
            }
            for (run, unit) in units.iter().enumerate() {
                let at = if run == 2 { turn.checked_sub(STEPS / 2) } else { Some(turn) };
                let (Some(unit), Some(at)) = (unit, at.filter(|at| *at < STEPS)) else { continue };
                assert_eq!(step(unit, run, at), expected[run][at], "{fmi:?} {run} {at}");
            }
        }
        assert_eq!(units[1].as_ref().map(Unit::reset), Some(OK));
        let last = units[2].as_ref().expect("the instance exists").get(&[2]).1[0];
        assert_eq!(last.to_bits(), expected[2][STEPS - 1][0], "a reset changes its own instance only");
    }
}

#[test]
fn instances_run_side_by_side_in_threads() {
    let folder = Resources::write("threads", &resources(&model(), STEPS));
    let expected: Vec<_> = (0..4).map(|run| run_alone(Fmi::Two, &folder, run)).collect();
    let side_by_side: Vec<_> = thread::scope(|scope| {
        let folder = &folder;
        let runs: Vec<_> = (0..4).map(|run| scope.spawn(move || run_alone(BOTH[run % 2], folder, run))).collect();
        runs.into_iter().map(|run| run.join().expect("the thread ends")).collect()
    });
    assert_eq!(side_by_side, expected);
}
