//! What an importer gives to an FMU: of its callbacks only the logger is used.

use std::ffi::{CString, c_char, c_int, c_void};

/// The logger of FMI 2.0: environment, name of the instance, status, category, format, values.
type Logger = unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char, ...);

/// `fmi2CallbackFunctions`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct CallbackFunctions {
    logger: Option<Logger>,
    allocate_memory: Option<unsafe extern "C" fn(usize, usize) -> *mut c_void>,
    free_memory: Option<unsafe extern "C" fn(*mut c_void)>,
    step_finished: Option<unsafe extern "C" fn(*mut c_void, c_int)>,
    environment: *mut c_void,
}

impl CallbackFunctions {
    /// Tells the importer of an error, if it listens.
    pub fn log_error(&self, instance: &CString, text: &str) {
        let Some(logger) = self.logger else { return };
        let text = CString::new(text.replace('\0', " ")).unwrap_or_default();
        // SAFETY: all pointers are to texts that live until the call returns, and the format takes the one text that follows.
        unsafe {
            logger(
                self.environment,
                instance.as_ptr(),
                status::ERROR,
                c"logStatusError".as_ptr(),
                c"%s".as_ptr(),
                text.as_ptr(),
            );
        }
    }
}

/// Values of `fmi2Status` that are used.
pub mod status {
    use std::ffi::c_int;

    /// The call succeeded.
    pub const OK: c_int = 0;
    /// The call failed; the instance can go on being asked.
    pub const ERROR: c_int = 3;
}
