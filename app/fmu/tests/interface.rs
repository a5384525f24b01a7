//! The shared library through its C functions, as an importer calls them, beside the network that it was made of.

#[allow(unsafe_code, missing_docs, reason = "the functions of FMI take pointers of the importer")]
#[path = "../library/lib.rs"]
mod library;

use std::ffi::{CString, c_int, c_void};
use std::fs;
use std::path::PathBuf;
use std::process;

use interplay_building::discretise::Model;
use interplay_building::network::{Network, Wall, Zone};

const GUID: &str = "{0-0}";
const ERROR: c_int = 3;

/// Two zones and a wall that stores heat and gets sun.
fn model() -> Model {
    let zones = [Zone::named("office"), Zone::named("store")];
    let walls = [
        Wall { solar_aperture_m2: 1.0, ..Wall::new("office", "store", 40.0).with_capacity_kj_per_k(900.0) },
        Wall::new("office", "ambient", 30.0),
        Wall::new("store", "ambient", 60.0),
    ];
    Model::exact(&Network::new(&zones, &walls).expect("a network"), 1800.0).expect("a model")
}

fn ambient_c(step: usize) -> f64 {
    10.0 + 5.0 * (step as f64).sin()
}

fn gains_kw(step: usize) -> [f64; 3] {
    [0.1 * (step % 5) as f64, 0.03, 0.2 * (step % 3) as f64]
}

fn line<T: ToString>(word: &str, numbers: impl IntoIterator<Item = T>) -> String {
    let numbers: Vec<String> = numbers.into_iter().map(|number| number.to_string()).collect();
    format!("{word} {}\n", numbers.join(" "))
}

/// The resources of `steps` steps.
fn resources(model: &Model, steps: usize) -> String {
    let nodes = model.network().node_count();
    let flat = |matrix: by_columns::Rows| matrix.into_iter().flatten().collect::<Vec<f64>>();
    [
        format!("interplay-plant 1\nguid {GUID}\nstep_s 1800\nnodes {nodes}\nzones 2\ngained 3\nsteps {steps}\n"),
        line("initial_c", vec![20.0; nodes]),
        line("state", flat(by_columns::rows(nodes, nodes, |unit| model.state_product(unit)))),
        line("gain", flat(by_columns::rows(nodes, 3, |unit| model.gain_product(unit)))),
        line("outdoor", model.gain_product(model.network().ambient_kw_per_k())),
        line("ambient_c", (0..steps).map(ambient_c)),
        line("gains_kw", (0..steps).flat_map(gains_kw)),
    ]
    .concat()
}

/// Matrices as lists of rows, found by products with unit vectors.
mod by_columns {
    pub type Rows = Vec<Vec<f64>>;

    /// The rows of the matrix whose products with unit vectors of `nodes` entries are given.
    pub fn rows(nodes: usize, count: usize, product: impl Fn(&[f64]) -> Vec<f64>) -> Rows {
        let mut rows = vec![vec![0.0; count]; nodes];
        for column in 0..count {
            let mut unit = vec![0.0; nodes];
            unit[column] = 1.0;
            for (row, value) in rows.iter_mut().zip(product(&unit)) {
                row[column] = value;
            }
        }
        rows
    }
}

/// A folder with the resources, and its URI.
fn folder(test: &str, content: &str) -> (PathBuf, CString) {
    let folder = std::env::temp_dir().join(format!("interplay fmu {test} {}", process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    fs::write(folder.join("plant.txt"), content).expect("a file");
    let uri = CString::new(format!("file://{}", folder.display()).replace(' ', "%20")).expect("no zero");
    (folder, uri)
}

/// Makes an instance without a logger; null if that is refused.
fn instantiate(uri: &CString, guid: &str) -> *mut c_void {
    let (name, guid) = (CString::new("house").expect("no zero"), CString::new(guid).expect("no zero"));
    // A structure of five null pointers: no logger.
    let callbacks = [std::ptr::null_mut::<c_void>(); 5];
    #[allow(unsafe_code, reason = "the functions of FMI take pointers")]
    // SAFETY: all texts and the callbacks live until the end of the call; the callbacks are copied.
    unsafe {
        library::fmi2Instantiate(name.as_ptr(), 1, guid.as_ptr(), uri.as_ptr(), callbacks.as_ptr().cast(), 0, 0)
    }
}

fn get(component: *mut c_void, references: &[u32]) -> (c_int, Vec<f64>) {
    let mut values = vec![f64::NAN; references.len()];
    #[allow(unsafe_code, reason = "the functions of FMI take pointers")]
    // SAFETY: both lists have the stated length.
    let status = unsafe { library::fmi2GetReal(component, references.as_ptr(), references.len(), values.as_mut_ptr()) };
    (status, values)
}

fn set(component: *mut c_void, references: &[u32], values: &[f64]) -> c_int {
    #[allow(unsafe_code, reason = "the functions of FMI take pointers")]
    // SAFETY: both lists have the stated length.
    unsafe {
        library::fmi2SetReal(component, references.as_ptr(), references.len(), values.as_ptr())
    }
}

fn free(component: *mut c_void) {
    #[allow(unsafe_code, reason = "the functions of FMI take pointers")]
    // SAFETY: it is not used afterwards.
    unsafe {
        library::fmi2FreeInstance(component);
    }
}

#[test]
fn the_library_moves_as_the_network_does() {
    let (model, steps) = (model(), 60);
    let (folder, uri) = folder("moves", &resources(&model, steps));
    let component = instantiate(&uri, GUID);
    assert!(!component.is_null());
    assert_eq!(library::fmi2SetupExperiment(component, 0, 0.0, 0.0, 0, 0.0), 0);
    assert_eq!(
        (library::fmi2EnterInitializationMode(component), library::fmi2ExitInitializationMode(component)),
        (0, 0)
    );
    for round in 0..2 {
        let mut nodes_c = vec![20.0; model.network().node_count()];
        for step in 0..steps / 2 {
            let heat_kw = [0.5 * (step as f64).cos(), -0.2];
            assert_eq!(set(component, &[0, 1], &heat_kw), 0);
            // Two steps at once.
            assert_eq!(library::fmi2DoStep(component, 3600.0 * step as f64, 3600.0, 0), 0);
            for step in [2 * step, 2 * step + 1] {
                model.step(&mut nodes_c, &heat_kw, ambient_c(step), &gains_kw(step));
            }
            let (status, values) = get(component, &[2, 3, 0, 4, 5, 6]);
            let next = (2 * step + 2).min(steps - 1);
            let expected = [nodes_c[0], nodes_c[1], heat_kw[0], gains_kw(next)[0], gains_kw(next)[1], ambient_c(next)];
            assert_eq!(status, 0);
            assert!(
                values.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-11),
                "{round} {step}: {values:?} {expected:?}"
            );
        }
        // The weather is over.
        assert_eq!(library::fmi2DoStep(component, 1800.0 * steps as f64, 1800.0, 0), ERROR);
        assert_eq!(library::fmi2Reset(component), 0);
    }
    free(component);
    fs::remove_dir_all(folder).expect("it is there");
}

#[test]
fn wrong_calls_are_errors_and_leave_the_instance_as_it_was() {
    let (folder, uri) = folder("wrong", &resources(&model(), 10));
    assert!(instantiate(&uri, "{another}").is_null());
    let component = instantiate(&uri, GUID);
    assert_eq!(library::fmi2SetupExperiment(component, 0, 0.0, 0.0, 0, 0.0), 0);
    for (time_s, step_s) in
        [(0.0, 900.0), (0.0, 0.0), (0.0, -1800.0), (1800.0, 1800.0), (0.0, f64::NAN), (f64::NAN, 1800.0)]
    {
        assert_eq!(library::fmi2DoStep(component, time_s, step_s, 0), ERROR, "{time_s} {step_s}");
    }
    assert_eq!(library::fmi2DoStep(component, 0.0, f64::INFINITY, 0), ERROR);
    assert_eq!(set(component, &[0], &[f64::NAN]), ERROR);
    assert_eq!(set(component, &[2], &[20.0]), ERROR, "an output");
    assert_eq!(set(component, &[7], &[20.0]), ERROR, "no variable");
    assert_eq!(get(component, &[u32::MAX]).0, ERROR);
    assert_eq!(library::fmi2SetupExperiment(component, 0, 0.0, 100.0, 0, 0.0), ERROR, "no whole step");
    assert_eq!(library::fmi2SetupExperiment(component, 0, 0.0, 18_000.0, 0, 0.0), ERROR, "no weather");
    assert_eq!(get(component, &[0, 2]), (0, vec![0.0, 20.0]));
    assert_eq!(library::fmi2DoStep(component, 0.0, 1800.0, 0), 0);
    assert_eq!(library::fmi2DoStep(std::ptr::null_mut(), 0.0, 1800.0, 0), ERROR);
    free(component);
    fs::remove_dir_all(folder).expect("it is there");
}

#[test]
fn spoilt_resources_are_refused() {
    let sound = resources(&model(), 3);
    let spoilt = [
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
    for (number, text) in spoilt.iter().enumerate() {
        assert_ne!(text, &sound);
        let (folder, uri) = folder(&format!("spoilt-{number}"), text);
        assert!(instantiate(&uri, GUID).is_null(), "{number}");
        fs::remove_dir_all(folder).expect("it is there");
    }
    assert!(instantiate(&CString::new("file:///nowhere/at/all").expect("no zero"), GUID).is_null());
}

#[test]
fn what_is_not_supported_says_so() {
    let null = std::ptr::null_mut();
    assert_eq!(library::fmi2GetInteger(null, std::ptr::null(), 0, null), 0, "no variables are asked for");
    assert_eq!(library::fmi2SetString(null, std::ptr::null(), 1, null), ERROR);
    assert_eq!(library::fmi2GetFMUstate(null, std::ptr::null_mut()), ERROR);
    assert_eq!(library::fmi2CancelStep(null), ERROR);
}
