//! The functions of FMI 2.0 that differ from those of FMI 3.0. What they do with pointers is in [`calls`].

use std::ffi::{c_char, c_double, c_int, c_uint, c_void};
use std::ptr;

use super::logger::{CallbackFunctions, Logger, status};
use super::{calls, location};
use calls::{text, with_instance};

/// `fmi2Type` of co-simulation.
const CO_SIMULATION: c_int = 1;

/// The platform of the C types: the default one of the standard.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

/// Makes an instance; null if the resources do not fit.
///
/// # Safety
/// As FMI 2.0 says of `fmi2Instantiate`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
    instance_name: *const c_char,
    fmu_type: c_int,
    guid: *const c_char,
    resource_location: *const c_char,
    functions: *const CallbackFunctions,
    _visible: c_int,
    _logging_on: c_int,
) -> *mut c_void {
    // SAFETY: the importer's texts end with a zero, and its callbacks live as long as the instance.
    let (name, guid, location, callbacks) =
        unsafe { (text(instance_name), text(guid), text(resource_location), functions.as_ref()) };
    let Some(callbacks) = callbacks else { return ptr::null_mut() };
    calls::instantiate(name, Logger::Fmi2(*callbacks), guid, || {
        if fmu_type == CO_SIMULATION {
            Ok(location::folder(&location.to_string_lossy()))
        } else {
            Err("this FMU is for co-simulation only".to_owned())
        }
    })
}

/// Accepts any log settings: only errors are logged.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetDebugLogging(
    _component: *mut c_void,
    _logging_on: c_int,
    _count: usize,
    _categories: *const *const c_char,
) -> c_int {
    status::OK
}

/// Sets the start time, a whole number of steps after the first midnight.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetupExperiment(
    component: *mut c_void,
    _tolerance_defined: c_int,
    _tolerance: c_double,
    start_time_s: c_double,
    _stop_time_defined: c_int,
    _stop_time_s: c_double,
) -> c_int {
    with_instance(component, |instance| instance.begin_at(start_time_s))
}

/// Begins the initialisation, which needs no action.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2EnterInitializationMode(component: *mut c_void) -> c_int {
    with_instance(component, |_| Ok(()))
}

/// Reads the values of variables.
///
/// # Safety
/// Both lists have `count` entries.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(
    component: *mut c_void,
    references: *const c_uint,
    count: usize,
    values: *mut c_double,
) -> c_int {
    // SAFETY: what this function demands.
    unsafe { calls::read_values(component, references, count, values) }
}

/// Sets inputs.
///
/// # Safety
/// Both lists have `count` entries.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetReal(
    component: *mut c_void,
    references: *const c_uint,
    count: usize,
    values: *const c_double,
) -> c_int {
    // SAFETY: what this function demands.
    unsafe { calls::set_values(component, references, count, values) }
}

/// Advances the simulation by whole steps.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2DoStep(
    component: *mut c_void,
    current_time_s: c_double,
    step_s: c_double,
    _no_set_state_before: c_int,
) -> c_int {
    with_instance(component, |instance| instance.advance(current_time_s, step_s))
}
