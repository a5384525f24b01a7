//! Copies of the state, and their bytes.

use std::ptr;

use crate::house::{GUID, Resources, STEP_S, model, resources};
use crate::unit::{BOTH, ERROR, Fmi, OK, State, Unit};

const STEPS: usize = 30;
const ALL: [u32; 8] = [0, 1, 2, 3, 4, 5, 6, 7];

fn none() -> State {
    State(ptr::null_mut())
}

/// An instance after some steps, and its state then.
fn halfway(fmi: Fmi, folder: &Resources) -> (Unit, State) {
    let unit = Unit::new(fmi, folder.path(), GUID).expect("an instance");
    assert_eq!(unit.begin(0.0), OK);
    walk(&unit, 0, STEPS / 2);
    let mut state = none();
    assert_eq!(unit.save(&mut state), OK);
    assert!(!state.0.is_null());
    (unit, state)
}

/// Steps with heat that changes, and all values after each.
fn walk(unit: &Unit, from: usize, to: usize) -> Vec<Vec<u64>> {
    let step = |step: usize| {
        assert_eq!(unit.set(&[0, 1], &[(step as f64).sin(), 0.4]), OK);
        assert_eq!(unit.step(STEP_S * step as f64, STEP_S), OK);
        values(unit)
    };
    (from..to).map(step).collect()
}

fn values(unit: &Unit) -> Vec<u64> {
    unit.get(&ALL).1.into_iter().map(f64::to_bits).collect()
}

#[test]
fn a_run_from_a_restored_state_equals_the_original_run() {
    let folder = Resources::write("state", &resources(&model(), STEPS));
    for fmi in BOTH {
        let (unit, mut state) = halfway(fmi, &folder);
        let then = values(&unit);
        let continued = walk(&unit, STEPS / 2, STEPS);
        // Twice: the state is a copy, which steps do not change.
        for round in 0..2 {
            assert_eq!(unit.restore(&state), OK);
            assert_eq!(values(&unit), then, "{fmi:?} {round}");
            assert_eq!(walk(&unit, STEPS / 2, STEPS), continued, "{fmi:?} {round}");
        }
        // The memory of a state is used again.
        let place = state.0;
        assert_eq!(unit.save(&mut state), OK);
        assert_eq!(state.0, place);
        let end = values(&unit);
        assert_eq!((unit.reset(), unit.restore(&state)), (OK, OK));
        assert_eq!(values(&unit), end);
        assert_eq!((unit.forget(&mut state), state.0.is_null()), (OK, true));
        assert_eq!(unit.forget(&mut state), OK, "freeing a null state succeeds");
        assert_eq!(unit.restore(&state), ERROR);
        assert_eq!(values(&unit), end);
    }
}

#[test]
fn bytes_of_a_state_continue_in_another_instance_of_either_version() {
    let folder = Resources::write("bytes", &resources(&model(), STEPS));
    for (fmi, other) in BOTH.into_iter().flat_map(|fmi| BOTH.map(|other| (fmi, other))) {
        let (unit, mut state) = halfway(fmi, &folder);
        let (status, bytes) = unit.bytes(&state);
        assert_eq!(status, OK);
        let continued = walk(&unit, STEPS / 2, STEPS);
        assert_eq!(unit.forget(&mut state), OK);
        drop(unit);
        let unit = Unit::new(other, folder.path(), GUID).expect("an instance");
        let (status, mut state) = unit.state_of(&bytes);
        assert_eq!((status, unit.bytes(&state)), (OK, (OK, bytes)));
        assert_eq!(unit.restore(&state), OK);
        assert_eq!(walk(&unit, STEPS / 2, STEPS), continued, "{fmi:?} {other:?}");
        assert_eq!(unit.forget(&mut state), OK);
    }
}

#[test]
fn corrupt_bytes_of_an_fmu_state_are_refused() {
    let folder = Resources::write("corrupt-bytes", &resources(&model(), STEPS));
    let (unit, mut state) = halfway(Fmi::Three, &folder);
    let (_, valid) = unit.bytes(&state);
    let identity = "interplay-state 1\n".len() + 8;
    let with = |at: usize, bytes: &[u8]| {
        let mut corrupt = valid.clone();
        corrupt[at..at + bytes.len()].copy_from_slice(bytes);
        corrupt
    };
    let step = identity + GUID.len();
    let mut corrupt: Vec<(Vec<u8>, &str)> = vec![
        (Vec::new(), "not a state"),
        (with(0, b"I"), "not a state"),
        ([&valid[..], &[0]].concat(), "more bytes"),
        (with(identity, b"{1-0}"), "another FMU"),
        (with(identity - 8, &u64::MAX.to_le_bytes()), "fewer bytes"),
        (with(step, &(STEPS as u64 + 1).to_le_bytes()), "does not fit"),
        (with(step + 8, &u64::MAX.to_le_bytes()), "fewer bytes"),
        (with(step + 8, &[4, 0, 0, 0, 0, 0, 0, 0, 1]), "does not fit"),
        (with(step + 24, &f64::NAN.to_le_bytes()), "finite"),
    ];
    corrupt.extend((18..valid.len()).map(|length| (valid[..length].to_vec(), "fewer bytes")));
    for (bytes, said) in &corrupt {
        let (status, state) = unit.state_of(bytes);
        assert_eq!((status, state.0.is_null()), (ERROR, true), "{said}");
        let message = unit.last_message();
        assert!(message.contains(said), "`{message}` does not contain `{said}`");
    }
    assert_eq!(unit.forget(&mut state), OK);
}

#[test]
fn a_null_pointer_as_fmu_state_is_refused() {
    let folder = Resources::write("null-state", &resources(&model(), STEPS));
    for fmi in BOTH {
        let unit = Unit::new(fmi, folder.path(), GUID).expect("an instance");
        assert_eq!(unit.restore(&none()), ERROR);
        assert_eq!(unit.bytes(&none()).0, ERROR);
    }
}
