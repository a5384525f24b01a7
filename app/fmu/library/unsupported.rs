//! Functions that the standards demand and that this FMU does not support, as its descriptions say: variables of other types
//! than real numbers, clocks, events, derivatives, asynchronous steps, and the interfaces other than co-simulation.

use std::ffi::{c_char, c_int, c_void};
use std::ptr;

use super::logger::{LogMessage, status};

/// Exports functions that take a list of variables of a type that this FMU does not have: an empty list succeeds.
macro_rules! no_variables {
    ($($name:ident($($argument:ty),*);)*) => {$(
        /// This FMU has no variables of this type.
        #[unsafe(no_mangle)]
        pub extern "C" fn $name(_: *mut c_void, _: *const u32, count: usize $(, _: $argument)*) -> c_int {
            if count == 0 { status::OK } else { status::ERROR }
        }
    )*};
}

no_variables! {
    fmi2GetInteger(*mut c_void);
    fmi2GetBoolean(*mut c_void);
    fmi2GetString(*mut c_void);
    fmi2SetInteger(*mut c_void);
    fmi2SetBoolean(*mut c_void);
    fmi2SetString(*mut c_void);
    fmi3GetFloat32(*mut f32, usize);
    fmi3GetInt8(*mut i8, usize);
    fmi3GetUInt8(*mut u8, usize);
    fmi3GetInt16(*mut i16, usize);
    fmi3GetUInt16(*mut u16, usize);
    fmi3GetInt32(*mut i32, usize);
    fmi3GetUInt32(*mut u32, usize);
    fmi3GetInt64(*mut i64, usize);
    fmi3GetUInt64(*mut u64, usize);
    fmi3GetBoolean(*mut bool, usize);
    fmi3GetString(*mut *const c_char, usize);
    fmi3GetBinary(*mut usize, *mut *const u8, usize);
    fmi3GetClock(*mut bool);
    fmi3SetFloat32(*const f32, usize);
    fmi3SetInt8(*const i8, usize);
    fmi3SetUInt8(*const u8, usize);
    fmi3SetInt16(*const i16, usize);
    fmi3SetUInt16(*const u16, usize);
    fmi3SetInt32(*const i32, usize);
    fmi3SetUInt32(*const u32, usize);
    fmi3SetInt64(*const i64, usize);
    fmi3SetUInt64(*const u64, usize);
    fmi3SetBoolean(*const bool, usize);
    fmi3SetString(*const *const c_char, usize);
    fmi3SetBinary(*const usize, *const *const u8, usize);
    fmi3SetClock(*const bool);
    fmi3GetIntervalDecimal(*mut f64, *mut c_int);
    fmi3GetIntervalFraction(*mut u64, *mut u64, *mut c_int);
    fmi3GetShiftDecimal(*mut f64);
    fmi3GetShiftFraction(*mut u64, *mut u64);
    fmi3SetIntervalDecimal(*const f64);
    fmi3SetIntervalFraction(*const u64, *const u64);
    fmi3SetShiftDecimal(*const f64);
    fmi3SetShiftFraction(*const u64, *const u64);
    fmi3GetOutputDerivatives(*const i32, *mut f64, usize);
}

/// Exports functions that always fail.
macro_rules! refused {
    ($($name:ident($($argument:ty),*);)*) => {$(
        /// Not supported.
        #[unsafe(no_mangle)]
        pub extern "C" fn $name($(_: $argument),*) -> c_int {
            status::ERROR
        }
    )*};
}

refused! {
    fmi2GetDirectionalDerivative(*mut c_void, *const u32, usize, *const u32, usize, *const f64, *mut f64);
    fmi2SetRealInputDerivatives(*mut c_void, *const u32, usize, *const c_int, *const f64);
    fmi2GetRealOutputDerivatives(*mut c_void, *const u32, usize, *const c_int, *mut f64);
    fmi2CancelStep(*mut c_void);
    fmi2GetStatus(*mut c_void, c_int, *mut c_int);
    fmi2GetRealStatus(*mut c_void, c_int, *mut f64);
    fmi2GetIntegerStatus(*mut c_void, c_int, *mut c_int);
    fmi2GetBooleanStatus(*mut c_void, c_int, *mut c_int);
    fmi2GetStringStatus(*mut c_void, c_int, *mut c_void);
    fmi3EnterEventMode(*mut c_void);
    fmi3GetNumberOfVariableDependencies(*mut c_void, u32, *mut usize);
    fmi3GetVariableDependencies(*mut c_void, u32, *mut usize, *mut u32, *mut usize, *mut c_int, usize);
    fmi3GetDirectionalDerivative(*mut c_void, *const u32, usize, *const u32, usize, *const f64, usize, *mut f64, usize);
    fmi3GetAdjointDerivative(*mut c_void, *const u32, usize, *const u32, usize, *const f64, usize, *mut f64, usize);
    fmi3EnterConfigurationMode(*mut c_void);
    fmi3ExitConfigurationMode(*mut c_void);
    fmi3EvaluateDiscreteStates(*mut c_void);
    fmi3UpdateDiscreteStates(*mut c_void, *mut bool, *mut bool, *mut bool, *mut bool, *mut bool, *mut f64);
    fmi3EnterContinuousTimeMode(*mut c_void);
    fmi3CompletedIntegratorStep(*mut c_void, bool, *mut bool, *mut bool);
    fmi3SetTime(*mut c_void, f64);
    fmi3SetContinuousStates(*mut c_void, *const f64, usize);
    fmi3GetContinuousStateDerivatives(*mut c_void, *mut f64, usize);
    fmi3GetEventIndicators(*mut c_void, *mut f64, usize);
    fmi3GetContinuousStates(*mut c_void, *mut f64, usize);
    fmi3GetNominalsOfContinuousStates(*mut c_void, *mut f64, usize);
    fmi3GetNumberOfEventIndicators(*mut c_void, *mut usize);
    fmi3GetNumberOfContinuousStates(*mut c_void, *mut usize);
    fmi3EnterStepMode(*mut c_void);
    fmi3ActivateModelPartition(*mut c_void, u32, f64);
}

/// Model exchange is not supported: returns null.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateModelExchange(
    _instance_name: *const c_char,
    _instantiation_token: *const c_char,
    _resource_path: *const c_char,
    _visible: bool,
    _logging_on: bool,
    _environment: *mut c_void,
    _log_message: Option<LogMessage>,
) -> *mut c_void {
    ptr::null_mut()
}

/// Scheduled execution is not supported: returns null. The last three arguments are the callbacks of clocks and locks.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateScheduledExecution(
    _instance_name: *const c_char,
    _instantiation_token: *const c_char,
    _resource_path: *const c_char,
    _visible: bool,
    _logging_on: bool,
    _environment: *mut c_void,
    _log_message: Option<LogMessage>,
    _clock_update: Option<unsafe extern "C" fn(*mut c_void)>,
    _lock_preemption: Option<unsafe extern "C" fn()>,
    _unlock_preemption: Option<unsafe extern "C" fn()>,
) -> *mut c_void {
    ptr::null_mut()
}
