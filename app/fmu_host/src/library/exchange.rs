//! The functions of FMI 2.0 that only model exchange has (section 3.2).

use std::ffi::c_int;
use std::ptr;

use super::{Component, FALSE, Instance, Status, TRUE, checked, with_message};

/// `fmi2Discard` and `fmi2Error`: the values do not exist, and a shorter step may be tried. By the standard only the first allows that;
/// units of the OPTIMICA Compiler Toolkit, as those of BOPTEST, answer with the second where their inner equations have no solution.
const NO_VALUES: [Status; 2] = [2, 3];

/// `fmi2EventInfo`.
#[repr(C)]
#[derive(Default)]
struct EventInfo {
    new_discrete_states_needed: c_int,
    terminate_simulation: c_int,
    nominals_of_continuous_states_changed: c_int,
    values_of_continuous_states_changed: c_int,
    next_event_time_defined: c_int,
    next_event_time: f64,
}

/// What an event has changed.
#[derive(Clone, Copy, Debug, Default)]
pub struct EventOutcome {
    pub nominals: bool,
    pub states: bool,
    /// Time of the next event in time \[s\].
    pub next_s: Option<f64>,
}

impl Instance {
    /// Enters the mode of events, sets something in it, and handles events until nothing changes.
    ///
    /// # Errors
    /// As [`Instance::update`].
    pub fn event(&self, set: impl FnOnce(&Self) -> Result<(), String>) -> Result<EventOutcome, String> {
        self.call("fmi2EnterEventMode")?;
        set(self)?;
        self.update()
    }

    /// In the mode of events, updates discrete states until nothing changes, and goes on in continuous time.
    ///
    /// # Errors
    /// As [`Instance::initialize`]; also if the unit ends the simulation, or its events have no end.
    pub fn update(&self) -> Result<EventOutcome, String> {
        type Update = unsafe extern "C" fn(Component, *mut EventInfo) -> Status;
        const MAX_ITERATIONS: usize = 1000;
        let mut event = EventOutcome::default();
        for _ in 0..MAX_ITERATIONS {
            let mut info = EventInfo::default();
            // SAFETY: the type is that of the standard, the instance is alive, and the structure lives as long as the call.
            let status =
                unsafe { self.function::<Update>("fmi2NewDiscreteStates")?(self.component, ptr::from_mut(&mut info)) };
            checked("fmi2NewDiscreteStates", status)?;
            if info.terminate_simulation != FALSE {
                return Err("the unit ends the simulation".to_owned());
            }
            event.nominals |= info.nominals_of_continuous_states_changed != FALSE;
            event.states |= info.values_of_continuous_states_changed != FALSE;
            if info.new_discrete_states_needed == FALSE {
                event.next_s = (info.next_event_time_defined != FALSE).then_some(info.next_event_time);
                self.call("fmi2EnterContinuousTimeMode")?;
                return Ok(event);
            }
        }
        Err("its discrete states change without end".to_owned())
    }

    /// Sets time and continuous states.
    ///
    /// # Errors
    /// As [`Instance::initialize`].
    pub fn place(&self, time_s: f64, states: &[f64]) -> Result<(), String> {
        type SetTime = unsafe extern "C" fn(Component, f64) -> Status;
        // SAFETY: the type is that of the standard, and the instance is alive.
        let status = unsafe { self.function::<SetTime>("fmi2SetTime")?(self.component, time_s) };
        checked("fmi2SetTime", status)?;
        // The function only reads the list.
        self.list("fmi2SetContinuousStates", states.as_ptr().cast_mut(), states.len()).map(|_| ())
    }

    /// Reads a list of `count` numbers by a function such as `fmi2GetContinuousStates`; `false` if they do not exist.
    ///
    /// # Errors
    /// As [`Instance::initialize`].
    pub fn read(&self, name: &str, values: &mut [f64]) -> Result<bool, String> {
        self.list(name, values.as_mut_ptr(), values.len())
    }

    /// As [`Instance::read`], for values that must exist.
    ///
    /// # Errors
    /// As [`Instance::initialize`], and where they do not exist.
    pub fn demand(&self, name: &str, values: &mut [f64]) -> Result<(), String> {
        if self.read(name, values)? { Ok(()) } else { Err(with_message(&format!("`{name}` gives no values"))) }
    }

    fn list(&self, name: &str, values: *mut f64, count: usize) -> Result<bool, String> {
        type List = unsafe extern "C" fn(Component, *mut f64, usize) -> Status;
        if count == 0 {
            return Ok(true);
        }
        // SAFETY: the type is that of the standard, the instance is alive, and the list has the stated length.
        let status = unsafe { self.function::<List>(name)?(self.component, values, count) };
        if NO_VALUES.contains(&status) {
            return Ok(false);
        }
        checked(name, status).map(|()| true)
    }

    /// Tells the unit that a step is completed; returns whether it wants an event.
    ///
    /// # Errors
    /// As [`Instance::initialize`].
    pub fn complete_step(&self) -> Result<bool, String> {
        type Completed = unsafe extern "C" fn(Component, c_int, *mut c_int, *mut c_int) -> Status;
        let name = "fmi2CompletedIntegratorStep";
        let (mut wants_event, mut ends) = (FALSE, FALSE);
        // SAFETY: the type is that of the standard, the instance is alive, and both numbers live as long as the call.
        let status = unsafe {
            let (wants_event, ends) = (ptr::from_mut(&mut wants_event), ptr::from_mut(&mut ends));
            self.function::<Completed>(name)?(self.component, TRUE, wants_event, ends)
        };
        checked(name, status)?;
        if ends != FALSE { Err("the unit ends the simulation".to_owned()) } else { Ok(wants_event != FALSE) }
    }
}
