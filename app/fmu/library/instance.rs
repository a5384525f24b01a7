//! An instance of the FMU: the plant, its variables, and the time that its importer sees.

use std::ffi::CString;
use std::fs;
use std::path::Path;

use super::logger::Logger;
use super::plant::DiscretePlant;

/// How far the importer's time may be from that of a step, as a share of the step.
const MAX_TIME_ERROR_SHARE: f64 = 1e-6;

/// An instance of the FMU: a plant with the logger of its importer. It shares nothing with other instances.
#[derive(Debug)]
pub struct Instance {
    /// Name of the instance, for the log.
    pub name: CString,
    pub logger: Logger,
    pub plant: DiscretePlant,
}

/// The variables, by their value references, with `n` zones.
///
/// ```text
/// 0 … n−1     heat of the equipment [kW], input
/// n … 2n−1    temperature of the zone [°C], output
/// 2n … 3n−1   heat of people, machines and sun [kW], output
/// 3n          outdoor temperature [°C], output
/// 3n+1        time [s], which only FMI 3.0 lists as a variable
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Variable {
    Heat(usize),
    Temperature(usize),
    Gains(usize),
    Outdoor,
    Time,
}

impl Variable {
    fn parse(reference: u32, zones: usize) -> Result<Self, String> {
        let reference = reference as usize;
        let zone = reference % zones;
        match reference / zones {
            0 => Ok(Self::Heat(zone)),
            1 => Ok(Self::Temperature(zone)),
            2 => Ok(Self::Gains(zone)),
            _ if reference == 3 * zones => Ok(Self::Outdoor),
            _ if reference == 3 * zones + 1 => Ok(Self::Time),
            _ => Err(format!("no variable has the value reference {reference}")),
        }
    }
}

/// Reads the plant of the FMU with this GUID from its folder of resources.
///
/// # Errors
/// If the file cannot be read, or belongs to another FMU.
pub fn read_plant(folder: &Path, guid: &str) -> Result<DiscretePlant, String> {
    if folder.as_os_str().is_empty() {
        return Err("the importer gave no folder of resources".to_owned());
    }
    let path = folder.join("plant.txt");
    let text = fs::read_to_string(&path).map_err(|error| format!("cannot read {}: {error}", path.display()))?;
    let plant = DiscretePlant::parse(&text).map_err(|error| format!("{}: {error}", path.display()))?;
    if plant.guid == guid {
        Ok(plant)
    } else {
        Err(format!("the GUID is {guid}, and that of the resources is {}: they belong to another FMU", plant.guid))
    }
}

impl Instance {
    /// Begins at a time \[s\] that is a whole number of steps after the first midnight.
    ///
    /// # Errors
    /// If the time is not a whole number of steps, or if the weather ends before it.
    pub fn begin_at(&mut self, time_s: f64) -> Result<(), String> {
        let steps = self.whole_steps(time_s).ok_or_else(|| {
            format!("{time_s} s is not a whole number of steps of {} s since the first midnight", self.plant.step_s)
        })?;
        if steps >= self.plant.steps() {
            return Err(format!("the weather in the FMU ends before {time_s} s"));
        }
        self.plant.present.step = steps;
        Ok(())
    }

    /// Advances from a time by a duration \[s\] of whole steps.
    ///
    /// # Errors
    /// If the time is not that of the instance, the duration is not a whole number of steps, or a step fails. The state is
    /// then unchanged.
    pub fn advance(&mut self, time_s: f64, duration_s: f64) -> Result<(), String> {
        let step_s = self.plant.step_s;
        if self.whole_steps(time_s) != Some(self.plant.present.step) {
            let now_s = self.plant.time_s();
            return Err(format!("the step starts at {time_s} s, but the time of the FMU is {now_s} s"));
        }
        let steps = self.whole_steps(duration_s).filter(|steps| *steps > 0);
        let steps =
            steps.ok_or_else(|| format!("the step of {duration_s} s is not a whole number of steps of {step_s} s"))?;
        let before = self.plant.present.clone();
        (0..steps).try_for_each(|_| self.plant.advance()).inspect_err(|_| self.plant.present = before)
    }

    /// The number of steps in a duration, if it is a whole number.
    fn whole_steps(&self, time_s: f64) -> Option<usize> {
        let steps = time_s / self.plant.step_s;
        let is_whole = steps >= -MAX_TIME_ERROR_SHARE && (steps - steps.round()).abs() <= MAX_TIME_ERROR_SHARE;
        (is_whole && steps < 1e12).then(|| steps.round().max(0.0) as usize)
    }

    /// Returns the value of a variable.
    ///
    /// # Errors
    /// If no variable has this value reference.
    pub fn value(&self, reference: u32) -> Result<f64, String> {
        let plant = &self.plant;
        Ok(match Variable::parse(reference, plant.zones)? {
            Variable::Heat(zone) => plant.present.heat_kw[zone],
            Variable::Temperature(zone) => plant.present.nodes_c[zone],
            Variable::Gains(zone) => plant.gains_kw()[zone],
            Variable::Outdoor => plant.ambient_c(),
            Variable::Time => plant.time_s(),
        })
    }

    /// Sets an input.
    ///
    /// # Errors
    /// If the value reference is not that of an input, or if the value is not finite.
    pub fn set_value(&mut self, reference: u32, value: f64) -> Result<(), String> {
        match Variable::parse(reference, self.plant.zones)? {
            Variable::Heat(_) if !value.is_finite() => Err(format!("heat of {value} kW is not a finite number")),
            Variable::Heat(zone) => {
                self.plant.present.heat_kw[zone] = value;
                Ok(())
            }
            _ => Err(format!("the variable with the value reference {reference} is not an input and cannot be set")),
        }
    }
}
