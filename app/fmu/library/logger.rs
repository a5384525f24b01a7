//! Logs errors through the callback of the importer. Its other callbacks are not used.

use std::ffi::{CStr, CString, c_char, c_int, c_void};

/// The category of errors, which both descriptions list.
const CATEGORY: &CStr = c"logStatusError";

/// The logger of FMI 2.0: environment, name of the instance, status, category, format, values.
type Logger2 = unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char, ...);

/// `fmi3LogMessageCallback`: environment, status, category, message.
pub type LogMessage = unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char);

/// `fmi2CallbackFunctions`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct CallbackFunctions {
    logger: Option<Logger2>,
    allocate_memory: Option<unsafe extern "C" fn(usize, usize) -> *mut c_void>,
    free_memory: Option<unsafe extern "C" fn(*mut c_void)>,
    step_finished: Option<unsafe extern "C" fn(*mut c_void, c_int)>,
    environment: *mut c_void,
}

/// The log callback of an importer.
#[derive(Clone, Copy, Debug)]
pub enum Logger {
    /// Callbacks of FMI 2.0.
    Fmi2(CallbackFunctions),
    /// The callback of FMI 3.0, if the importer has one, and its first argument.
    Fmi3(Option<LogMessage>, *mut c_void),
}

impl Logger {
    /// Passes an error to the importer, if it has a log callback.
    pub fn log_error(&self, instance: &CStr, text: &str) {
        let text = CString::new(text.replace('\0', " ")).unwrap_or_default();
        match *self {
            Self::Fmi2(CallbackFunctions { logger: Some(log), environment, .. }) => {
                let (format, category) = (c"%s".as_ptr(), CATEGORY.as_ptr());
                // SAFETY: all pointers are to texts that live until the call returns, and the format takes the one text that
                // follows.
                unsafe { log(environment, instance.as_ptr(), status::ERROR, category, format, text.as_ptr()) }
            }
            Self::Fmi3(Some(log), environment) => {
                // SAFETY: both pointers are to texts that live until the call returns.
                unsafe { log(environment, status::ERROR, CATEGORY.as_ptr(), text.as_ptr()) }
            }
            Self::Fmi2(_) | Self::Fmi3(None, _) => {}
        }
    }
}

/// Values of `fmi2Status` and `fmi3Status` that are used; they are the same in both versions.
pub mod status {
    use std::ffi::c_int;

    pub const OK: c_int = 0;
    /// The call failed; the instance remains usable.
    pub const ERROR: c_int = 3;
}
