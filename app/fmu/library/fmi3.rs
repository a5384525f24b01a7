//! The functions of FMI 3.0 that differ from those of FMI 2.0. What they do with pointers is in [`calls`].

use std::ffi::{c_char, c_int, c_void};
use std::path::PathBuf;

use super::calls;
use super::logger::{LogMessage, Logger, status};
use calls::{text, with_instance};

/// `fmi3IntermediateUpdateCallback`, which is never called: time, three requests, whether the step may end early, and what then.
pub type IntermediateUpdate = unsafe extern "C" fn(*mut c_void, f64, bool, bool, bool, bool, *mut bool, *mut f64);

#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

/// Makes an instance. Returns null if the resources do not fit, or if the importer demands an event mode.
///
/// # Safety
/// As FMI 3.0 says of `fmi3InstantiateCoSimulation`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateCoSimulation(
    instance_name: *const c_char,
    instantiation_token: *const c_char,
    resource_path: *const c_char,
    _visible: bool,
    _logging_on: bool,
    event_mode_used: bool,
    _early_return_allowed: bool,
    _required_intermediate_variables: *const u32,
    _required_intermediate_variable_count: usize,
    environment: *mut c_void,
    log_message: Option<LogMessage>,
    _intermediate_update: Option<IntermediateUpdate>,
) -> *mut c_void {
    // SAFETY: the importer's texts end with a zero.
    let (name, token, path) = unsafe { (text(instance_name), text(instantiation_token), text(resource_path)) };
    calls::instantiate(name, Logger::Fmi3(log_message, environment), token, || {
        if event_mode_used {
            Err("this FMU has no event mode, as its description says".to_owned())
        } else {
            // FMI 3.0 gives a path of the system, FMI 2.0 a URI.
            Ok(PathBuf::from(&*path.to_string_lossy()))
        }
    })
}

/// Accepts any log settings: only errors are logged.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetDebugLogging(
    _instance: *mut c_void,
    _logging_on: bool,
    _count: usize,
    _categories: *const *const c_char,
) -> c_int {
    status::OK
}

/// Sets the start time \[s\], a whole number of steps after the first midnight.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3EnterInitializationMode(
    instance: *mut c_void,
    _tolerance_defined: bool,
    _tolerance: f64,
    start_time_s: f64,
    _stop_time_defined: bool,
    _stop_time_s: f64,
) -> c_int {
    with_instance(instance, |instance| instance.begin_at(start_time_s))
}

/// Refuses lists of different lengths: each variable has one value.
fn same_length(instance: *mut c_void, references: usize, values: usize) -> c_int {
    with_instance(instance, |_| {
        let lengths =
            || format!("the call has {references} value references and {values} values; each variable has one value");
        if references == values { Ok(()) } else { Err(lengths()) }
    })
}

/// Reads the values of variables.
///
/// # Safety
/// Both lists have the stated number of entries.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFloat64(
    instance: *mut c_void,
    references: *const u32,
    count: usize,
    values: *mut f64,
    value_count: usize,
) -> c_int {
    match same_length(instance, count, value_count) {
        // SAFETY: what this function demands; both lists have `count` entries.
        status::OK => unsafe { calls::read_values(instance, references, count, values) },
        error => error,
    }
}

/// Sets inputs.
///
/// # Safety
/// Both lists have the stated number of entries.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFloat64(
    instance: *mut c_void,
    references: *const u32,
    count: usize,
    values: *const f64,
    value_count: usize,
) -> c_int {
    match same_length(instance, count, value_count) {
        // SAFETY: what this function demands; both lists have `count` entries.
        status::OK => unsafe { calls::set_values(instance, references, count, values) },
        error => error,
    }
}

/// Advances the simulation by whole steps. No step ends early or raises an event. The last successful time is the end of the step,
/// or its beginning if it fails.
///
/// # Safety
/// Each of the last four pointers is null or can be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DoStep(
    instance: *mut c_void,
    current_time_s: f64,
    step_s: f64,
    _no_set_state_before: bool,
    event_handling_needed: *mut bool,
    terminate_simulation: *mut bool,
    early_return: *mut bool,
    last_successful_time_s: *mut f64,
) -> c_int {
    let mut time_s = current_time_s;
    let status = with_instance(instance, |instance| {
        let outcome = instance.advance(current_time_s, step_s);
        time_s = instance.plant.time_s();
        outcome
    });
    for flag in [event_handling_needed, terminate_simulation, early_return] {
        if !flag.is_null() {
            // SAFETY: it is not null, and what this function demands.
            unsafe { flag.write(false) };
        }
    }
    if !last_successful_time_s.is_null() {
        // SAFETY: it is not null, and what this function demands.
        unsafe { last_successful_time_s.write(time_s) };
    }
    status
}
