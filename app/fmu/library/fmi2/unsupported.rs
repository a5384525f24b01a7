//! Functions of FMI 2.0 that must exist and that this FMU does not support, as its description says: other types than reals,
//! derivatives, and steps that run on by themselves. Lists of no entries are no error.

use std::ffi::{c_int, c_void};

use super::super::logger::status;

/// A function about a list of variables: there are no variables of that type.
macro_rules! no_variables {
    ($($name:ident),*) => {$(
        /// There are no variables of this type.
        #[unsafe(no_mangle)]
        pub extern "C" fn $name(_: *mut c_void, _: *const u32, count: usize, _: *mut c_void) -> c_int {
            if count == 0 { status::OK } else { status::ERROR }
        }
    )*};
}

no_variables!(fmi2GetInteger, fmi2GetBoolean, fmi2GetString, fmi2SetInteger, fmi2SetBoolean, fmi2SetString);

/// A function that is refused, whatever it is given.
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
}
