//! What the functions of both versions do with the pointers of an importer.
//!
//! Both standards promise that an instance is one that was made here and that nobody freed, that a state is one of it, that texts
//! end with a zero, and that lists have as many entries as is said. Null pointers are refused nevertheless.

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::{ptr, slice};

use super::instance::{Instance, read_plant};
use super::logger::{Logger, status};
use super::snapshot::Snapshot;

/// Makes an instance from the plant in the folder of resources; null if that fails, and then the importer is told why.
pub fn instantiate(
    name: &CStr,
    logger: Logger,
    guid: &CStr,
    folder: impl FnOnce() -> Result<std::path::PathBuf, String>,
) -> *mut c_void {
    let made = catch_unwind(AssertUnwindSafe(|| read_plant(&folder()?, &guid.to_string_lossy())));
    match made.unwrap_or_else(|_| Err(FAULT.to_owned())) {
        Ok(plant) => Box::into_raw(Box::new(Instance { name: CString::from(name), logger, plant })).cast(),
        Err(error) => {
            logger.log_error(name, &error);
            ptr::null_mut()
        }
    }
}

/// What an importer is told of a panic.
const FAULT: &str = "the FMU has a fault of its own";

/// Asks an instance for something; an error is told to the importer, and a panic is one.
pub fn with_instance(instance: *mut c_void, action: impl FnOnce(&mut Instance) -> Result<(), String>) -> c_int {
    // SAFETY: an instance is null, or one of `instantiate` that is in use by this call alone (FMI 2.0, sections 2.1.1 and 4.2.4;
    // FMI 3.0 allows no more).
    let Some(instance) = (unsafe { instance.cast::<Instance>().as_mut() }) else { return status::ERROR };
    let outcome = catch_unwind(AssertUnwindSafe(|| action(instance)));
    match outcome.unwrap_or_else(|_| Err(FAULT.to_owned())) {
        Ok(()) => status::OK,
        Err(error) => {
            instance.logger.log_error(&instance.name, &error);
            status::ERROR
        }
    }
}

/// Frees an instance.
///
/// # Safety
/// It is null or one of [`instantiate`], and is not used any more.
pub unsafe fn free_instance(instance: *mut c_void) {
    if !instance.is_null() {
        // SAFETY: it was made by `Box::into_raw` and is freed once.
        drop(unsafe { Box::from_raw(instance.cast::<Instance>()) });
    }
}

/// A text of the importer; empty for a null pointer.
///
/// # Safety
/// The pointer is null or that of a text that ends with a zero.
pub unsafe fn text<'a>(pointer: *const c_char) -> &'a CStr {
    // SAFETY: what this function demands.
    if pointer.is_null() { c"" } else { unsafe { CStr::from_ptr(pointer) } }
}

/// A list of the importer; a list of no entries may be a null pointer.
///
/// # Safety
/// The pointer is null or that of `count` entries.
unsafe fn list<'a, T>(pointer: *const T, count: usize) -> Result<&'a [T], String> {
    match (count, pointer.is_null()) {
        (0, _) => Ok(&[]),
        (_, true) => Err("a list is a null pointer".to_owned()),
        // SAFETY: it is not null and has `count` entries.
        _ => Ok(unsafe { slice::from_raw_parts(pointer, count) }),
    }
}

/// A list of the importer that is written to.
///
/// # Safety
/// The pointer is null or that of `count` entries, which nobody else uses.
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

/// What an importer is told of a null pointer where a state should be.
const NO_STATE: &str = "the state is a null pointer";

/// Copies the state of an instance into the state that is pointed at, or into a new one where that is null.
///
/// # Safety
/// `state` is null, or points at null or at a state of this function or of [`deserialize_state`] that nobody freed.
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
/// `state` is null, or a state of [`get_state`] or [`deserialize_state`] that nobody freed.
pub unsafe fn set_state(instance: *mut c_void, state: *mut c_void) -> c_int {
    with_instance(instance, |instance| {
        // SAFETY: what this function demands.
        let snapshot = unsafe { state.cast::<Snapshot>().as_ref() }.ok_or(NO_STATE)?;
        snapshot.restore(&mut instance.plant)
    })
}

/// Frees a state and makes its pointer null. It is no error if there is none.
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
            return Err(format!("the state has {} bytes, and there is room for {size}", serialized.len()));
        }
        // SAFETY: what this function demands.
        unsafe { list_mut(bytes, size)? }.copy_from_slice(&serialized);
        Ok(())
    })
}

/// Makes a new state of bytes that were written by [`serialize_state`], by this instance or another one of the same FMU.
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
