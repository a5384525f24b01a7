//! An instance in either version of FMI, behind the same methods.

use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::Path;
use std::ptr;
use std::rc::Rc;

use crate::library::{self, LogMessage};

/// The status of a call that succeeded.
pub const OK: c_int = 0;
/// The status of a call that failed.
pub const ERROR: c_int = 3;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fmi {
    Two,
    Three,
}

pub const BOTH: [Fmi; 2] = [Fmi::Two, Fmi::Three];

/// A copy of the state, as the importer holds it.
#[derive(Debug)]
pub struct State(pub *mut c_void);

pub type Log = RefCell<Vec<String>>;

/// An instance, which is freed when it is dropped.
#[derive(Debug)]
pub struct Unit {
    fmi: Fmi,
    instance: *mut c_void,
    /// What the instance logged; FMI 3.0 only, for the logger of FMI 2.0 takes any number of arguments.
    log: Rc<Log>,
}

/// Keeps a message in the list that is the environment.
unsafe extern "C" fn keep(environment: *mut c_void, status: c_int, category: *const c_char, message: *const c_char) {
    // SAFETY: the environment is the list of a unit, which lives as long as its instance; the texts end with a zero.
    let (log, category, message) =
        unsafe { (&*environment.cast::<Log>(), CStr::from_ptr(category), CStr::from_ptr(message)) };
    log.borrow_mut().push(format!("{status} {} {}", category.to_string_lossy(), message.to_string_lossy()));
}

impl Unit {
    /// Makes an instance at the first midnight; an error has what was logged.
    pub fn new(fmi: Fmi, folder: &Path, guid: &str) -> Result<Self, Vec<String>> {
        let log = Rc::new(Log::default());
        let (name, guid) = (CString::new("house").expect("no zero"), CString::new(guid).expect("no zero"));
        let path = folder.display().to_string();
        let instance = match fmi {
            Fmi::Two => {
                let uri = CString::new(format!("file://{path}").replace(' ', "%20")).expect("no zero");
                // A structure of five null pointers: no logger.
                let callbacks = [ptr::null_mut::<c_void>(); 5];
                let callbacks = callbacks.as_ptr().cast();
                // SAFETY: all texts and the callbacks live until the end of the call; the callbacks are copied.
                unsafe { library::fmi2Instantiate(name.as_ptr(), 1, guid.as_ptr(), uri.as_ptr(), callbacks, 0, 0) }
            }
            Fmi::Three => instantiate3([&name, &guid, &CString::new(path).expect("no zero")], false, &log),
        };
        if instance.is_null() { Err(log.take()) } else { Ok(Self { fmi, instance, log }) }
    }

    /// Begins at a time \[s\].
    pub fn begin(&self, time_s: f64) -> c_int {
        let instance = self.instance;
        // SAFETY: the instance is not freed yet.
        unsafe {
            match self.fmi {
                Fmi::Two => library::fmi2SetupExperiment(instance, 0, 0.0, time_s, 0, 0.0)
                    .max(library::fmi2EnterInitializationMode(instance))
                    .max(library::fmi2ExitInitializationMode(instance)),
                Fmi::Three => library::fmi3EnterInitializationMode(instance, false, 0.0, time_s, false, 0.0)
                    .max(library::fmi3ExitInitializationMode(instance)),
            }
        }
    }

    /// Values of variables; not a number where none was written.
    pub fn get(&self, references: &[u32]) -> (c_int, Vec<f64>) {
        let (count, mut values) = (references.len(), vec![f64::NAN; references.len()]);
        // SAFETY: both lists have the stated length.
        let status = unsafe {
            match self.fmi {
                Fmi::Two => library::fmi2GetReal(self.instance, references.as_ptr(), count, values.as_mut_ptr()),
                Fmi::Three => {
                    library::fmi3GetFloat64(self.instance, references.as_ptr(), count, values.as_mut_ptr(), count)
                }
            }
        };
        (status, values)
    }

    pub fn set(&self, references: &[u32], values: &[f64]) -> c_int {
        let (count, references, value_count) = (references.len(), references.as_ptr(), values.len());
        // SAFETY: both lists have the stated length; FMI 2.0 is told one length, which the tests keep to.
        unsafe {
            match self.fmi {
                Fmi::Two => library::fmi2SetReal(self.instance, references, count.min(value_count), values.as_ptr()),
                Fmi::Three => library::fmi3SetFloat64(self.instance, references, count, values.as_ptr(), value_count),
            }
        }
    }

    /// Advances. In FMI 3.0 also checks that the last successful time is that of the plant and that no flag is raised.
    pub fn step(&self, time_s: f64, duration_s: f64) -> c_int {
        if self.fmi == Fmi::Two {
            return library::fmi2DoStep(self.instance, time_s, duration_s, 0);
        }
        let ([mut event, mut end, mut early], mut last_s) = ([true; 3], f64::NAN);
        let out = (&mut event, &mut end, &mut early, &mut last_s);
        // SAFETY: the four pointers are those of variables.
        let status =
            unsafe { library::fmi3DoStep(self.instance, time_s, duration_s, false, out.0, out.1, out.2, out.3) };
        assert_eq!([event, end, early], [false; 3]);
        assert_eq!(last_s, self.get(&[7]).1[0], "the last time is that of the variable `time`");
        status
    }

    /// Returns to the first midnight.
    pub fn reset(&self) -> c_int {
        // SAFETY: the instance is not freed yet.
        unsafe {
            match self.fmi {
                Fmi::Two => library::fmi2Reset(self.instance),
                Fmi::Three => library::fmi3Reset(self.instance),
            }
        }
    }

    /// Copies the state into `state`, or into a new one if its pointer is null.
    pub fn save(&self, state: &mut State) -> c_int {
        // SAFETY: the pointer is null or that of a state.
        unsafe {
            match self.fmi {
                Fmi::Two => library::fmi2GetFMUstate(self.instance, &mut state.0),
                Fmi::Three => library::fmi3GetFMUState(self.instance, &mut state.0),
            }
        }
    }

    pub fn restore(&self, state: &State) -> c_int {
        // SAFETY: the pointer is null or that of a state.
        unsafe {
            match self.fmi {
                Fmi::Two => library::fmi2SetFMUstate(self.instance, state.0),
                Fmi::Three => library::fmi3SetFMUState(self.instance, state.0),
            }
        }
    }

    pub fn forget(&self, state: &mut State) -> c_int {
        // SAFETY: the pointer is null or that of a state.
        unsafe {
            match self.fmi {
                Fmi::Two => library::fmi2FreeFMUstate(self.instance, &mut state.0),
                Fmi::Three => library::fmi3FreeFMUState(self.instance, &mut state.0),
            }
        }
    }

    pub fn bytes(&self, state: &State) -> (c_int, Vec<u8>) {
        let (instance, mut size) = (self.instance, 0);
        // SAFETY: the pointers are those of a state and of variables, and the list has the stated size.
        unsafe {
            let status = match self.fmi {
                Fmi::Two => library::fmi2SerializedFMUstateSize(instance, state.0, &mut size),
                Fmi::Three => library::fmi3SerializedFMUStateSize(instance, state.0, &mut size),
            };
            let mut bytes = vec![0; size];
            let start = bytes.as_mut_ptr();
            let written = match self.fmi {
                Fmi::Two => library::fmi2SerializeFMUstate(instance, state.0, start, size),
                Fmi::Three => library::fmi3SerializeFMUState(instance, state.0, start, size),
            };
            (status.max(written), bytes)
        }
    }

    /// Makes a state of bytes.
    pub fn state_of(&self, bytes: &[u8]) -> (c_int, State) {
        let mut state = State(ptr::null_mut());
        // SAFETY: the list has the stated size.
        let status = unsafe {
            match self.fmi {
                Fmi::Two => library::fmi2DeSerializeFMUstate(self.instance, bytes.as_ptr(), bytes.len(), &mut state.0),
                Fmi::Three => {
                    library::fmi3DeserializeFMUState(self.instance, bytes.as_ptr(), bytes.len(), &mut state.0)
                }
            }
        };
        (status, state)
    }

    /// What was logged last; FMI 3.0 only.
    pub fn last_message(&self) -> String {
        self.log.borrow().last().cloned().unwrap_or_default()
    }
}

impl Drop for Unit {
    fn drop(&mut self) {
        // SAFETY: the instance is not used afterwards.
        unsafe {
            match self.fmi {
                Fmi::Two => library::fmi2FreeInstance(self.instance),
                Fmi::Three => library::fmi3FreeInstance(self.instance),
            }
        }
    }
}

/// Makes an instance of FMI 3.0 of name, token and path; null if that is refused.
pub fn instantiate3(texts: [&CStr; 3], events: bool, log: &Rc<Log>) -> *mut c_void {
    let [name, token, path] = texts.map(CStr::as_ptr);
    let (environment, keep): (_, LogMessage) = (Rc::as_ptr(log).cast_mut().cast(), keep);
    // SAFETY: all texts live until the end of the call, and the log as long as the instance.
    unsafe {
        library::fmi3InstantiateCoSimulation(
            name,
            token,
            path,
            false,
            false,
            events,
            false,
            ptr::null(),
            0,
            environment,
            Some(keep),
            None,
        )
    }
}
