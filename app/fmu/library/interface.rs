//! The functions of FMI 2.0 that this FMU supports.
//!
//! Pointers come from the importer. FMI 2.0 promises that a component is one that `fmi2Instantiate` returned and nobody freed,
//! that texts end with a zero, and that lists have as many entries as is said. Null pointers are refused nevertheless.

use std::ffi::{CStr, CString, c_char, c_double, c_int, c_uint, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::{ptr, slice};

use super::callbacks::{CallbackFunctions, status};
use super::instance::{Instance, read_plant};
use super::location;

/// `fmi2Type` of co-simulation.
const CO_SIMULATION: c_int = 1;

/// Asks an instance for something; an error is told to the importer, and a panic is one.
fn with_instance(component: *mut c_void, action: impl FnOnce(&mut Instance) -> Result<(), String>) -> c_int {
    // SAFETY: a component is null or an instance that is in use by this call alone (FMI 2.0, sections 2.1.1 and 4.2.4).
    let Some(instance) = (unsafe { component.cast::<Instance>().as_mut() }) else { return status::ERROR };
    let outcome = catch_unwind(AssertUnwindSafe(|| action(instance)));
    match outcome.unwrap_or_else(|_| Err("the FMU has a fault of its own".to_owned())) {
        Ok(()) => status::OK,
        Err(error) => {
            instance.callbacks.log_error(&instance.name, &error);
            status::ERROR
        }
    }
}

/// A text of the importer; empty for a null pointer.
///
/// # Safety
/// The pointer is null or that of a text that ends with a zero.
unsafe fn text<'a>(pointer: *const c_char) -> &'a CStr {
    // SAFETY: what this function demands.
    if pointer.is_null() { c"" } else { unsafe { CStr::from_ptr(pointer) } }
}

/// The platform of the types: that of the standard.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

/// The version of the standard.
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
    let name = CString::from(name);
    let made = catch_unwind(AssertUnwindSafe(|| {
        if fmu_type != CO_SIMULATION {
            return Err("this FMU is for co-simulation only".to_owned());
        }
        read_plant(&location::folder(&location.to_string_lossy()), &guid.to_string_lossy())
    }));
    match made.unwrap_or_else(|_| Err("the FMU has a fault of its own".to_owned())) {
        Ok(plant) => Box::into_raw(Box::new(Instance { name, callbacks: *callbacks, plant })).cast(),
        Err(error) => {
            callbacks.log_error(&name, &error);
            ptr::null_mut()
        }
    }
}

/// Frees an instance.
///
/// # Safety
/// The component is null or one of `fmi2Instantiate`, and is not used any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeInstance(component: *mut c_void) {
    if !component.is_null() {
        // SAFETY: it was made by `Box::into_raw` and is freed once.
        drop(unsafe { Box::from_raw(component.cast::<Instance>()) });
    }
}

/// Logging needs no setting: only errors are logged.
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

/// There is nothing to initialise.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2EnterInitializationMode(component: *mut c_void) -> c_int {
    with_instance(component, |_| Ok(()))
}

/// There is nothing to do at the end of the initialisation.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2ExitInitializationMode(component: *mut c_void) -> c_int {
    with_instance(component, |_| Ok(()))
}

/// Ends the simulation; outputs can still be read.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2Terminate(component: *mut c_void) -> c_int {
    with_instance(component, |_| Ok(()))
}

/// Returns to the first midnight.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2Reset(component: *mut c_void) -> c_int {
    with_instance(component, |instance| {
        instance.plant.reset();
        Ok(())
    })
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
    with_instance(component, |instance| {
        if count == 0 {
            return Ok(());
        }
        if references.is_null() || values.is_null() {
            return Err("a list is a null pointer".to_owned());
        }
        // SAFETY: neither is null, and both have `count` entries.
        let (references, values) =
            unsafe { (slice::from_raw_parts(references, count), slice::from_raw_parts_mut(values, count)) };
        for (reference, value) in references.iter().zip(values) {
            *value = instance.value(*reference)?;
        }
        Ok(())
    })
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
    with_instance(component, |instance| {
        if count == 0 {
            return Ok(());
        }
        if references.is_null() || values.is_null() {
            return Err("a list is a null pointer".to_owned());
        }
        // SAFETY: neither is null, and both have `count` entries.
        let (references, values) =
            unsafe { (slice::from_raw_parts(references, count), slice::from_raw_parts(values, count)) };
        references.iter().zip(values).try_for_each(|(reference, value)| instance.set_value(*reference, *value))
    })
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
