//! Calls that are wrong or not supported.

use std::ffi::CString;
use std::path::Path;
use std::ptr;
use std::rc::Rc;

use crate::house::{GUID, Resources, STEP_S, model, resources};
use crate::library;
use crate::unit::{BOTH, ERROR, Fmi, Log, OK, Unit, instantiate3};

#[test]
fn invalid_calls_fail_and_leave_the_instance_unchanged() {
    let folder = Resources::write("wrong", &resources(&model(), 10));
    for fmi in BOTH {
        assert!(Unit::new(fmi, folder.path(), "{another}").is_err());
        let unit = Unit::new(fmi, folder.path(), GUID).expect("an instance");
        assert_eq!(unit.begin(0.0), OK);
        for (time_s, step_s) in [
            (0.0, 900.0),
            (0.0, 0.0),
            (0.0, -STEP_S),
            (STEP_S, STEP_S),
            (0.0, f64::NAN),
            (f64::NAN, STEP_S),
            (0.0, f64::INFINITY),
            // The weather ends within the step.
            (0.0, 11.0 * STEP_S),
        ] {
            assert_eq!(unit.step(time_s, step_s), ERROR, "{fmi:?} {time_s} {step_s}");
        }
        assert_eq!(unit.set(&[0], &[f64::NAN]), ERROR);
        assert_eq!(unit.set(&[2], &[20.0]), ERROR, "an output");
        assert_eq!(unit.set(&[7], &[20.0]), ERROR, "time");
        assert_eq!(unit.set(&[8], &[20.0]), ERROR, "no variable");
        assert_eq!((unit.get(&[8]).0, unit.get(&[u32::MAX]).0), (ERROR, ERROR));
        assert_eq!(unit.begin(100.0), ERROR, "not a whole step");
        assert_eq!(unit.begin(10.0 * STEP_S), ERROR, "no weather");
        assert_eq!(unit.get(&[0, 2, 7]), (OK, vec![0.0, 20.0, 0.0]), "{fmi:?}");
        assert_eq!(unit.step(0.0, STEP_S), OK);
    }
    assert_eq!(library::fmi2DoStep(ptr::null_mut(), 0.0, STEP_S, 0), ERROR);
    // SAFETY: the instance is null.
    assert_eq!(unsafe { library::fmi3Reset(ptr::null_mut()) }, ERROR);
}

#[test]
fn an_importer_of_fmi_3_gets_an_error_message() {
    let folder = Resources::write("told", &resources(&model(), 10));
    let unit = Unit::new(Fmi::Three, folder.path(), GUID).expect("an instance");
    assert_eq!(unit.begin(0.0), OK);
    assert_eq!(unit.last_message(), "");
    assert_eq!(unit.step(0.0, 900.0), ERROR);
    let said = unit.last_message();
    assert!(said.starts_with("3 logStatusError ") && said.contains("900 s") && said.contains("1800 s"), "{said}");
    assert_eq!(unit.set(&[0, 1], &[1.0]), ERROR);
    assert!(unit.last_message().contains("2 value references and 1 values"), "{}", unit.last_message());
    let log = Unit::new(Fmi::Three, folder.path(), "{another}").expect_err("another FMU");
    assert!(log.len() == 1 && log[0].contains("{another}"), "{log:?}");
    let log = Unit::new(Fmi::Three, Path::new(""), GUID).expect_err("no folder");
    assert!(log.len() == 1 && log[0].contains("no folder"), "{log:?}");
    let (log, path) = (Rc::new(Log::default()), CString::new(folder.path().display().to_string()).expect("no zero"));
    assert!(instantiate3([c"house", c"{0-0}", &path], true, &log).is_null());
    let log = log.take();
    assert!(log.len() == 1 && log[0].contains("event mode"), "{log:?}");
}

#[test]
fn corrupt_resources_are_refused() {
    let sound = resources(&model(), 3);
    let corrupt = [
        String::new(),
        sound.replace("interplay-plant 1", "interplay-plant 2"),
        sound[..sound.len() / 2].to_owned(),
        sound.replace("nodes 3", "nodes 18446744073709551615"),
        sound.replace("nodes 3", "nodes 4294967295"),
        sound.replace("zones 2", "zones 0"),
        sound.replace("gained 3", "gained 1"),
        sound.replace("gained 3", "gained 4"),
        sound.replace("steps 3", "steps 0"),
        sound.replace("step_s 1800", "step_s -1"),
        sound.replace("initial_c 20", "initial_c NaN"),
    ];
    for (number, text) in corrupt.iter().enumerate() {
        assert_ne!(text, &sound);
        let folder = Resources::write(&format!("corrupt-{number}"), text);
        for fmi in BOTH {
            assert!(Unit::new(fmi, folder.path(), GUID).is_err(), "{fmi:?} {number}");
        }
    }
    assert!(BOTH.iter().all(|fmi| Unit::new(*fmi, Path::new("/nowhere/at/all"), GUID).is_err()));
}

#[test]
fn unsupported_fmi_functions_return_an_error() {
    let null = ptr::null_mut();
    assert_eq!(library::fmi2GetInteger(null, ptr::null(), 0, null), OK, "an empty list of variables");
    assert_eq!(library::fmi2SetString(null, ptr::null(), 1, null), ERROR);
    assert_eq!(library::fmi2CancelStep(null), ERROR);
    assert_eq!(library::fmi3GetInt32(null, ptr::null(), 0, ptr::null_mut(), 0), OK, "an empty list of variables");
    assert_eq!(library::fmi3GetInt32(null, ptr::null(), 1, ptr::null_mut(), 1), ERROR);
    assert_eq!(library::fmi3EnterEventMode(null), ERROR);
}
