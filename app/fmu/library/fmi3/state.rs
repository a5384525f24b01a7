//! Copies of the state of an instance, and their bytes (FMI 3.0, "Getting and Setting the Complete FMU State").

use std::ffi::{c_int, c_void};

use super::super::calls;

/// Copies the state of an instance.
///
/// # Safety
/// As FMI 3.0 says of `fmi3GetFMUState`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFMUState(instance: *mut c_void, state: *mut *mut c_void) -> c_int {
    // SAFETY: what the standard demands of the importer.
    unsafe { calls::get_state(instance, state) }
}

/// Returns an instance to a state.
///
/// # Safety
/// As FMI 3.0 says of `fmi3SetFMUState`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFMUState(instance: *mut c_void, state: *mut c_void) -> c_int {
    // SAFETY: what the standard demands of the importer.
    unsafe { calls::set_state(instance, state) }
}

/// Frees a state.
///
/// # Safety
/// As FMI 3.0 says of `fmi3FreeFMUState`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeFMUState(instance: *mut c_void, state: *mut *mut c_void) -> c_int {
    // SAFETY: what the standard demands of the importer.
    unsafe { calls::free_state(instance, state) }
}

/// Number of bytes of a state.
///
/// # Safety
/// As FMI 3.0 says of `fmi3SerializedFMUStateSize`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializedFMUStateSize(
    instance: *mut c_void,
    state: *mut c_void,
    size: *mut usize,
) -> c_int {
    // SAFETY: what the standard demands of the importer.
    unsafe { calls::serialized_state_size(instance, state, size) }
}

/// Writes the bytes of a state.
///
/// # Safety
/// As FMI 3.0 says of `fmi3SerializeFMUState`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializeFMUState(
    instance: *mut c_void,
    state: *mut c_void,
    bytes: *mut u8,
    size: usize,
) -> c_int {
    // SAFETY: what the standard demands of the importer.
    unsafe { calls::serialize_state(instance, state, bytes, size) }
}

/// Makes a state of its bytes.
///
/// # Safety
/// As FMI 3.0 says of `fmi3DeserializeFMUState`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DeserializeFMUState(
    instance: *mut c_void,
    bytes: *const u8,
    size: usize,
    state: *mut *mut c_void,
) -> c_int {
    // SAFETY: what the standard demands of the importer.
    unsafe { calls::deserialize_state(instance, bytes, size, state) }
}
