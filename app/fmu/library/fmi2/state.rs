//! Copies of the state of an instance, and their bytes (FMI 2.0, section 2.1.8).

use std::ffi::{c_int, c_void};

use super::super::calls;

/// Copies the state of an instance.
///
/// # Safety
/// As FMI 2.0 says of `fmi2GetFMUstate`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(instance: *mut c_void, state: *mut *mut c_void) -> c_int {
    // SAFETY: what the standard demands of the importer.
    unsafe { calls::get_state(instance, state) }
}

/// Returns an instance to a state.
///
/// # Safety
/// As FMI 2.0 says of `fmi2SetFMUstate`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetFMUstate(instance: *mut c_void, state: *mut c_void) -> c_int {
    // SAFETY: what the standard demands of the importer.
    unsafe { calls::set_state(instance, state) }
}

/// Frees a state.
///
/// # Safety
/// As FMI 2.0 says of `fmi2FreeFMUstate`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(instance: *mut c_void, state: *mut *mut c_void) -> c_int {
    // SAFETY: what the standard demands of the importer.
    unsafe { calls::free_state(instance, state) }
}

/// Number of bytes of a state.
///
/// # Safety
/// As FMI 2.0 says of `fmi2SerializedFMUstateSize`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(
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
/// As FMI 2.0 says of `fmi2SerializeFMUstate`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(
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
/// As FMI 2.0 says of `fmi2DeSerializeFMUstate`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    instance: *mut c_void,
    bytes: *const u8,
    size: usize,
    state: *mut *mut c_void,
) -> c_int {
    // SAFETY: what the standard demands of the importer.
    unsafe { calls::deserialize_state(instance, bytes, size, state) }
}
