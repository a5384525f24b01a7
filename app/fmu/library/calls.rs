//! What the functions of both versions do with the pointers of an importer.
//!
//! Both standards promise that an instance was made here and is not freed, that a state belongs to the instance, that texts end
//! with a zero, and that lists have the stated number of entries. Null pointers are refused nevertheless.

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::{ptr, slice};

use super::instance::{Instance, read_plant};
use super::logger::{Logger, status};
use super::snapshot::Snapshot;

/// Makes an instance from the plant in the folder of resources. On failure logs the error and returns null.
pub fn instantiate(
    name: &CStr,
    logger: Logger,
    guid: &CStr,
    folder: impl FnOnce() -> Result<std::path::PathBuf, String>,
) -> *mut c_void {
    let made = catch_unwind(AssertUnwindSafe(|| read_plant(&folder()?, &guid.to_string_lossy())));
    match made.unwrap_or_else(|_| Err(PANIC_MESSAGE.to_owned())) {
        Ok(plant) => Box::into_raw(Box::new(Instance { name: CString::from(name), logger, plant })).cast(),
        Err(error) => {
            logger.log_error(name, &error);
            ptr::null_mut()
        }
    }
}

/// The message that is logged after a panic.
const PANIC_MESSAGE: &str = "internal error of the FMU";

/// Calls a function of an instance. Logs an error or a panic and returns the status.
pub fn with_instance(instance: *mut c_void, action: impl FnOnce(&mut Instance) -> Result<(), String>) -> c_int {
    // SAFETY: an instance is null, or one of `instantiate` that is in use by this call alone (FMI 2.0, sections 2.1.1 and 4.2.4;
    // FMI 3.0 allows no more).
    let Some(instance) = (unsafe { instance.cast::<Instance>().as_mut() }) else { return status::ERROR };
    let outcome = catch_unwind(AssertUnwindSafe(|| action(instance)));
    match outcome.unwrap_or_else(|_| Err(PANIC_MESSAGE.to_owned())) {
        Ok(()) => status::OK,
        Err(error) => {
            instance.logger.log_error(&instance.name, &error);
            status::ERROR
        }
    }
}

/// Accepts a call that needs no action.
///
/// # Safety
/// `instance` is null or one of [`instantiate`].
pub unsafe fn accept(instance: *mut c_void) -> c_int {
    with_instance(instance, |_| Ok(()))
}

/// Returns an instance to the first midnight.
///
/// # Safety
/// `instance` is null or one of [`instantiate`].
pub unsafe fn reset(instance: *mut c_void) -> c_int {
    with_instance(instance, |instance| {
        instance.plant.reset();
        Ok(())
    })
}

/// Frees an instance.
///
/// # Safety
/// `instance` is null or one of [`instantiate`], and is not used any more.
pub unsafe fn free_instance(instance: *mut c_void) {
    if !instance.is_null() {
        // SAFETY: it was made by `Box::into_raw` and is freed once.
        drop(unsafe { Box::from_raw(instance.cast::<Instance>()) });
    }
}

/// Borrows a text of the importer; a null pointer counts as the empty text.
///
/// # Safety
/// The pointer is null or points at a text that ends with a zero.
pub unsafe fn text<'a>(pointer: *const c_char) -> &'a CStr {
    // SAFETY: what this function demands.
    if pointer.is_null() { c"" } else { unsafe { CStr::from_ptr(pointer) } }
}

/// Borrows a list of the importer; an empty list may be a null pointer.
///
/// # Safety
/// The pointer is null or points at `count` entries.
unsafe fn list<'a, T>(pointer: *const T, count: usize) -> Result<&'a [T], String> {
    match (count, pointer.is_null()) {
        (0, _) => Ok(&[]),
        (_, true) => Err("a list is a null pointer".to_owned()),
        // SAFETY: it is not null and has `count` entries.
        _ => Ok(unsafe { slice::from_raw_parts(pointer, count) }),
    }
}

/// Borrows a list of the importer for writing.
///
/// # Safety
/// The pointer is null or points at `count` entries, which nothing else uses during the call.
unsafe fn list_mut<'a, T>(pointer: *mut T, count: usize) -> Result<&'a mut [T], String> {
    match (count, pointer.is_null()) {
        (0, _) => Ok(&mut []),
        (_, true) => Err("a list is a null pointer".to_owned()),
        // SAFETY: it is not null and has `count` entries.
        _ => Ok(unsafe { slice::from_raw_parts_mut(pointer, count) }),
    }
}

/// Reads the values of variables.
///
/// # Safety
/// Both lists have `count` entries.
pub unsafe fn read_values(instance: *mut c_void, references: *const u32, count: usize, values: *mut f64) -> c_int {
    with_instance(instance, |instance| {
        // SAFETY: what this function demands.
        let (references, values) = unsafe { (list(references, count)?, list_mut(values, count)?) };
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
pub unsafe fn set_values(instance: *mut c_void, references: *const u32, count: usize, values: *const f64) -> c_int {
    with_instance(instance, |instance| {
        // SAFETY: what this function demands.
        let (references, values) = unsafe { (list(references, count)?, list(values, count)?) };
        references.iter().zip(values).try_for_each(|(reference, value)| instance.set_value(*reference, *value))
    })
}

/// The message that is logged for a null pointer in place of a state.
const NO_STATE: &str = "the state is a null pointer";

/// Copies the state of an instance into the state that `state` points at, or into a new one if that is null.
///
/// # Safety
/// `state` is null, or points at null or at a state of this function or of [`deserialize_state`] that is not freed.
pub unsafe fn get_state(instance: *mut c_void, state: *mut *mut c_void) -> c_int {
    with_instance(instance, |instance| {
        // SAFETY: what this function demands.
        let state = unsafe { state.as_mut() }.ok_or(NO_STATE)?;
        let snapshot = Snapshot::of(&instance.plant);
        // SAFETY: what this function demands.
        match unsafe { state.cast::<Snapshot>().as_mut() } {
            Some(old) => *old = snapshot,
            None => *state = Box::into_raw(Box::new(snapshot)).cast(),
        }
        Ok(())
    })
}

/// Returns an instance to a state.
///
/// # Safety
/// `state` is null, or a state of [`get_state`] or [`deserialize_state`] that is not freed.
pub unsafe fn set_state(instance: *mut c_void, state: *mut c_void) -> c_int {
    with_instance(instance, |instance| {
        // SAFETY: what this function demands.
        let snapshot = unsafe { state.cast::<Snapshot>().as_ref() }.ok_or(NO_STATE)?;
        snapshot.restore(&mut instance.plant)
    })
}

/// Frees a state and makes its pointer null. A null pointer is accepted.
///
/// # Safety
/// As [`get_state`].
pub unsafe fn free_state(instance: *mut c_void, state: *mut *mut c_void) -> c_int {
    with_instance(instance, |_| {
        // SAFETY: what this function demands.
        if let Some(state) = unsafe { state.as_mut() }.filter(|state| !state.is_null()) {
            // SAFETY: it was made by `Box::into_raw` and is freed once, for the pointer becomes null.
            drop(unsafe { Box::from_raw(state.cast::<Snapshot>()) });
            *state = ptr::null_mut();
        }
        Ok(())
    })
}

/// Writes the number of bytes that a state has when it is serialised.
///
/// # Safety
/// `state` as in [`set_state`]; `size` is null or can be written to.
pub unsafe fn serialized_state_size(instance: *mut c_void, state: *mut c_void, size: *mut usize) -> c_int {
    with_instance(instance, |_| {
        // SAFETY: what this function demands.
        let snapshot = unsafe { state.cast::<Snapshot>().as_ref() }.ok_or(NO_STATE)?;
        // SAFETY: what this function demands.
        *unsafe { size.as_mut() }.ok_or("the size is a null pointer")? = snapshot.to_bytes().len();
        Ok(())
    })
}

/// Writes the bytes of a state.
///
/// # Safety
/// `state` as in [`set_state`]; `bytes` has `size` entries.
pub unsafe fn serialize_state(instance: *mut c_void, state: *mut c_void, bytes: *mut u8, size: usize) -> c_int {
    with_instance(instance, |_| {
        // SAFETY: what this function demands.
        let snapshot = unsafe { state.cast::<Snapshot>().as_ref() }.ok_or(NO_STATE)?;
        let serialized = snapshot.to_bytes();
        if serialized.len() != size {
            return Err(format!("the state has {} bytes, but the list has room for {size}", serialized.len()));
        }
        // SAFETY: what this function demands.
        unsafe { list_mut(bytes, size)? }.copy_from_slice(&serialized);
        Ok(())
    })
}

/// Makes a new state from bytes that [`serialize_state`] wrote, for this instance or another one of the same FMU.
///
/// # Safety
/// `bytes` has `size` entries; `state` is null or can be written to. What it points at is not read: it may be uninitialised.
pub unsafe fn deserialize_state(
    instance: *mut c_void,
    bytes: *const u8,
    size: usize,
    state: *mut *mut c_void,
) -> c_int {
    with_instance(instance, |instance| {
        // SAFETY: what this function demands.
        let snapshot = Snapshot::from_bytes(unsafe { list(bytes, size)? })?;
        snapshot.check(&instance.plant)?;
        if state.is_null() {
            return Err(NO_STATE.to_owned());
        }
        // SAFETY: it is not null, and what this function demands.
        unsafe { state.write(Box::into_raw(Box::new(snapshot)).cast()) };
        Ok(())
    })
}
