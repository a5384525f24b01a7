//! The library of a unit and its functions: the only module that calls foreign code.
//!
//! Declarations follow `fmi2Functions.h` of FMI 2.0.4. Booleans are `int`. The status of a call that worked is 0 (ok) or 1 (warning).
#![allow(unsafe_code, reason = "the functions of a unit are C")]

mod exchange;

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::Path;
use std::ptr;
use std::sync::Mutex;

use libloading::{Library as Loaded, Symbol};

pub use exchange::EventOutcome;

type Component = *mut c_void;
type Status = c_int;
type Logger = unsafe extern "C" fn(*mut c_void, *const c_char, Status, *const c_char, *const c_char, *const c_char);

/// Which interface of a unit is used: `fmi2Type`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
pub enum Interface {
    ModelExchange = 0,
    CoSimulation = 1,
}

/// The worst status with which a call still worked: `fmi2Warning`.
const WARNING: Status = 1;
const TRUE: c_int = 1;
const FALSE: c_int = 0;

/// `fmi2CallbackFunctions`.
#[repr(C)]
struct Callbacks {
    logger: Logger,
    allocate: unsafe extern "C" fn(usize, usize) -> *mut c_void,
    free: unsafe extern "C" fn(*mut c_void),
    step_finished: Option<unsafe extern "C" fn(*mut c_void, Status)>,
    environment: *mut c_void,
}

/// The last message of the unit; it explains a status.
static LAST_MESSAGE: Mutex<String> = Mutex::new(String::new());

/// The format of a message that is a single text.
const ONE_TEXT: &CStr = c"%s";

/// Keeps a message. In the standard any number of arguments follow the format; a Rust function cannot declare them.
/// Units run only on Linux with x86-64. There the first of these arguments is passed where a sixth fixed argument would be. It is read
/// only if the format says that it is a text. Other formats are kept as they are.
unsafe extern "C" fn log(
    _: *mut c_void,
    _: *const c_char,
    _: Status,
    _: *const c_char,
    message: *const c_char,
    first: *const c_char,
) {
    if message.is_null() {
        return;
    }
    // SAFETY: messages are zero-terminated texts (FMI 2.0.4, section 2.1.5).
    let mut text = unsafe { CStr::from_ptr(message) };
    if text == ONE_TEXT && !first.is_null() {
        // SAFETY: this format guarantees that the argument is a zero-terminated text.
        text = unsafe { CStr::from_ptr(first) };
    }
    if let Ok(mut last) = LAST_MESSAGE.lock() {
        *last = text.to_string_lossy().trim().to_owned();
    }
}

/// An instance of a unit in its library.
pub struct Instance {
    library: Loaded,
    /// What stands before the names of the functions: nothing, or the name of the model.
    prefix: String,
    component: Component,
    /// The unit keeps pointers to them.
    _callbacks: Box<Callbacks>,
}

impl Instance {
    /// Loads the library and creates an instance. `resources` is the URI of its folder.
    ///
    /// # Errors
    /// The error of the loader or the unit.
    pub fn new(path: &Path, guid: &str, resources: &str, interface: Interface) -> Result<Self, String> {
        // SAFETY: loading runs the initialisers of the library, as a user who names an FMU intends; this process does nothing else.
        let library = unsafe { Loaded::new(path) }.map_err(|error| format!("its library cannot be loaded: {error}"))?;
        let callbacks = Box::new(Callbacks {
            logger: log,
            allocate: libc::calloc,
            free: libc::free,
            step_finished: None,
            environment: ptr::null_mut(),
        });
        let text = |text: &str| CString::new(text).map_err(|_| "a text has a zero in it".to_owned());
        let (name, guid, resources) = (text("case")?, text(guid)?, text(resources)?);
        type Instantiate = unsafe extern "C" fn(
            *const c_char,
            c_int,
            *const c_char,
            *const c_char,
            *const Callbacks,
            c_int,
            c_int,
        ) -> Component;
        let plain = || path.file_stem().map(|stem| format!("{}_", stem.to_string_lossy())).unwrap_or_default();
        // SAFETY: the function is not called.
        let is_plain = unsafe { function::<Instantiate>(&library, "", "fmi2Instantiate") }.is_ok();
        let prefix = if is_plain { String::new() } else { plain() };
        // SAFETY: the type is that of the standard.
        let instantiate: Symbol<'_, Instantiate> = unsafe { function(&library, &prefix, "fmi2Instantiate")? };
        // SAFETY: all pointers live as long as the call, and the callbacks as long as the instance.
        let component = unsafe {
            let (name, guid) = (name.as_ptr(), guid.as_ptr());
            instantiate(name, interface as c_int, guid, resources.as_ptr(), &raw const *callbacks, FALSE, FALSE)
        };
        if component.is_null() {
            return Err(with_message("it makes no instance"));
        }
        Ok(Self { library, prefix, component, _callbacks: callbacks })
    }

    /// Sets up the experiment from `start_s` on, and initialises the unit.
    ///
    /// # Errors
    /// The call that failed, with the unit's message.
    pub fn initialize(&self, start_s: f64) -> Result<(), String> {
        type SetUp = unsafe extern "C" fn(Component, c_int, f64, f64, c_int, f64) -> Status;
        // SAFETY: the type is that of the standard, and the instance is alive.
        let status =
            unsafe { self.function::<SetUp>("fmi2SetupExperiment")?(self.component, FALSE, 0.0, start_s, FALSE, 0.0) };
        checked("fmi2SetupExperiment", status)?;
        self.call("fmi2EnterInitializationMode")?;
        self.call("fmi2ExitInitializationMode")
    }

    /// Sets numbers and booleans.
    ///
    /// # Errors
    /// As [`Instance::initialize`].
    pub fn set(&self, reals: &[(u32, f64)], booleans: &[(u32, bool)]) -> Result<(), String> {
        let (references, values): (Vec<u32>, Vec<f64>) = reals.iter().copied().unzip();
        self.transfer("fmi2SetReal", &references, values.as_ptr().cast_mut())?;
        let values: Vec<c_int> = booleans.iter().map(|(_, value)| if *value { TRUE } else { FALSE }).collect();
        let references: Vec<u32> = booleans.iter().map(|(reference, _)| *reference).collect();
        self.transfer("fmi2SetBoolean", &references, values.as_ptr().cast_mut())
    }

    /// The current numbers, followed by the booleans as 0 or 1.
    ///
    /// # Errors
    /// As [`Instance::initialize`].
    pub fn numbers(&self, reals: &[u32], booleans: &[u32]) -> Result<Vec<f64>, String> {
        let mut values = vec![0.0; reals.len()];
        self.transfer("fmi2GetReal", reals, values.as_mut_ptr())?;
        let mut flags: Vec<c_int> = vec![0; booleans.len()];
        self.transfer("fmi2GetBoolean", booleans, flags.as_mut_ptr())?;
        values.extend(flags.iter().map(|flag| if *flag == FALSE { 0.0 } else { 1.0 }));
        Ok(values)
    }

    /// The current texts.
    ///
    /// # Errors
    /// As [`Instance::initialize`].
    pub fn strings(&self, references: &[u32]) -> Result<Vec<String>, String> {
        let mut pointers: Vec<*const c_char> = vec![ptr::null(); references.len()];
        self.transfer("fmi2GetString", references, pointers.as_mut_ptr())?;
        let texts = pointers.into_iter().map(|pointer| {
            if pointer.is_null() {
                return String::new();
            }
            // SAFETY: texts are zero-terminated and live until the next call (FMI 2.0.4, section 2.1.7).
            unsafe { CStr::from_ptr(pointer) }.to_string_lossy().into_owned()
        });
        Ok(texts.collect())
    }

    /// Simulates a communication step.
    ///
    /// # Errors
    /// As [`Instance::initialize`].
    pub fn step(&self, from_s: f64, step_s: f64) -> Result<(), String> {
        type DoStep = unsafe extern "C" fn(Component, f64, f64, c_int) -> Status;
        // SAFETY: the type is that of the standard, and the instance is alive.
        let status = unsafe { self.function::<DoStep>("fmi2DoStep")?(self.component, from_s, step_s, TRUE) };
        checked("fmi2DoStep", status)
    }

    /// Returns the unit to the state before the initialisation.
    ///
    /// # Errors
    /// As [`Instance::initialize`].
    pub fn reset(&self) -> Result<(), String> {
        self.call("fmi2Reset")
    }

    /// Ends the simulation.
    ///
    /// # Errors
    /// As [`Instance::initialize`].
    pub fn terminate(&self) -> Result<(), String> {
        self.call("fmi2Terminate")
    }

    /// Looks up a function of the instance's library.
    ///
    /// # Safety
    /// `F` is the type that the standard gives the function of this name.
    unsafe fn function<F>(&self, name: &str) -> Result<Symbol<'_, F>, String> {
        // SAFETY: the caller guarantees it.
        unsafe { function(&self.library, &self.prefix, name) }
    }

    /// Calls a function whose only argument is the instance.
    fn call(&self, name: &str) -> Result<(), String> {
        type Plain = unsafe extern "C" fn(Component) -> Status;
        // SAFETY: the type is that of the standard, and the instance is alive.
        checked(name, unsafe { self.function::<Plain>(name)?(self.component) })
    }

    /// Calls a function that reads or writes a list of values, one for each reference.
    fn transfer<T>(&self, name: &str, references: &[u32], values: *mut T) -> Result<(), String> {
        if references.is_empty() {
            return Ok(());
        }
        type Transfer<T> = unsafe extern "C" fn(Component, *const u32, usize, *mut T) -> Status;
        // SAFETY: the type is that of the standard, the instance is alive, and both lists have the stated length; those that are set
        // are only read.
        let status = unsafe {
            self.function::<Transfer<T>>(name)?(self.component, references.as_ptr(), references.len(), values)
        };
        checked(name, status)
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        type Free = unsafe extern "C" fn(Component);
        // SAFETY: the type is that of the standard, and the instance is not used after this call.
        if let Ok(free) = unsafe { self.function::<Free>("fmi2FreeInstance") } {
            // SAFETY: as above.
            unsafe { free(self.component) };
        }
    }
}

/// Looks up a function of the library.
///
/// # Safety
/// `F` is the type that the standard gives the function of this name.
unsafe fn function<'a, F>(library: &'a Loaded, prefix: &str, name: &str) -> Result<Symbol<'a, F>, String> {
    // SAFETY: the caller guarantees it.
    unsafe { library.get(format!("{prefix}{name}").as_bytes()) }
        .map_err(|_| format!("its library has no function `{name}`"))
}

fn checked(name: &str, status: Status) -> Result<(), String> {
    if (0..=WARNING).contains(&status) {
        return Ok(());
    }
    let word = match status {
        2 => "a discarded step",
        3 => "an error",
        4 => "a fatal error",
        _ => "an unknown status",
    };
    Err(with_message(&format!("`{name}` ended with {word}")))
}

/// A reason with the last message of the unit.
fn with_message(reason: &str) -> String {
    let last = LAST_MESSAGE.lock().map(|last| last.clone()).unwrap_or_default();
    if last.is_empty() { reason.to_owned() } else { format!("{reason}: {last}") }
}
