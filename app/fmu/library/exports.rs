//! The functions that FMI 2.0 and FMI 3.0 define alike, each exported under both names.

use std::ffi::{c_int, c_void};

use super::calls;

/// Exports a function of [`calls`] under a name of the standard.
macro_rules! export_as {
    ($what:literal, $name:ident, $call:ident($($argument:ident: $type:ty),*)) => {
        #[doc = $what]
        ///
        /// # Safety
        /// As the standard says of the function with this name.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name($($argument: $type),*) -> c_int {
            // SAFETY: what the standard demands of the importer.
            unsafe { calls::$call($($argument),*) }
        }
    };
}

/// Exports functions of [`calls`], each under its name in FMI 2.0 and its name in FMI 3.0.
macro_rules! export_in_both {
    ($($what:literal: $fmi2:ident, $fmi3:ident = $call:ident $arguments:tt;)*) => {$(
        export_as!($what, $fmi2, $call $arguments);
        export_as!($what, $fmi3, $call $arguments);
    )*};
}

export_in_both! {
    "Ends the initialisation, which needs no action.":
        fmi2ExitInitializationMode, fmi3ExitInitializationMode = accept(instance: *mut c_void);
    "Ends the simulation; outputs can still be read.":
        fmi2Terminate, fmi3Terminate = accept(instance: *mut c_void);
    "Returns to the first midnight.":
        fmi2Reset, fmi3Reset = reset(instance: *mut c_void);
    "Copies the state of an instance.":
        fmi2GetFMUstate, fmi3GetFMUState = get_state(instance: *mut c_void, state: *mut *mut c_void);
    "Returns an instance to a state.":
        fmi2SetFMUstate, fmi3SetFMUState = set_state(instance: *mut c_void, state: *mut c_void);
    "Frees a state.":
        fmi2FreeFMUstate, fmi3FreeFMUState = free_state(instance: *mut c_void, state: *mut *mut c_void);
    "Writes the number of bytes of a serialised state.":
        fmi2SerializedFMUstateSize, fmi3SerializedFMUStateSize =
            serialized_state_size(instance: *mut c_void, state: *mut c_void, size: *mut usize);
    "Writes the bytes of a state.":
        fmi2SerializeFMUstate, fmi3SerializeFMUState =
            serialize_state(instance: *mut c_void, state: *mut c_void, bytes: *mut u8, size: usize);
    "Makes a state from its bytes.":
        fmi2DeSerializeFMUstate, fmi3DeserializeFMUState =
            deserialize_state(instance: *mut c_void, bytes: *const u8, size: usize, state: *mut *mut c_void);
}

/// Frees an instance of FMI 2.0.
///
/// # Safety
/// The component is null or one of `fmi2Instantiate`, and is not used any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeInstance(component: *mut c_void) {
    // SAFETY: what this function demands.
    unsafe { calls::free_instance(component) }
}

/// Frees an instance of FMI 3.0.
///
/// # Safety
/// The instance is null or one of `fmi3InstantiateCoSimulation`, and is not used any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeInstance(instance: *mut c_void) {
    // SAFETY: what this function demands.
    unsafe { calls::free_instance(instance) }
}
