//! A copy of the state of an instance, and its bytes.
//!
//! ```text
//! "interplay-state 1\n"                                   form and version
//! length of the GUID, the GUID                            as in `plant.txt`
//! step, number of nodes, number of zones
//! temperature of each node [°C], heat of each zone [kW]
//! ```
//!
//! Counts are u64, temperatures and heats f64, all little-endian, so that a state can be read on another machine.

use super::plant::{DiscretePlant, PlantState};

/// The first bytes, which name the format and its version.
const HEADER: &[u8] = b"interplay-state 1\n";

/// A state of a plant, with the GUID of its FMU.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    guid: String,
    state: PlantState,
}

impl Snapshot {
    pub fn of(plant: &DiscretePlant) -> Self {
        Self { guid: plant.guid.clone(), state: plant.present.clone() }
    }

    /// Returns a plant to this state.
    ///
    /// # Errors
    /// As [`Snapshot::check`]: the plant is unchanged.
    pub fn restore(&self, plant: &mut DiscretePlant) -> Result<(), String> {
        self.check(plant)?;
        plant.present.clone_from(&self.state);
        Ok(())
    }

    /// Whether a plant can have this state.
    ///
    /// # Errors
    /// If the state belongs to another FMU, or if its sizes, its step or its numbers are out of range.
    pub fn check(&self, plant: &DiscretePlant) -> Result<(), String> {
        let PlantState { step, nodes_c, heat_kw } = &self.state;
        if self.guid != plant.guid {
            return Err(format!("the state is of another FMU: its GUID is {}, not {}", self.guid, plant.guid));
        }
        if (nodes_c.len(), heat_kw.len()) != (plant.nodes(), plant.zones) || *step > plant.steps() {
            return Err("the state does not fit the network".to_owned());
        }
        if !nodes_c.iter().chain(heat_kw).all(|number| number.is_finite()) {
            return Err("a temperature or a heat of the state is not a finite number".to_owned());
        }
        Ok(())
    }

    pub fn to_bytes(&self) -> Vec<u8> {
        let PlantState { step, nodes_c, heat_kw } = &self.state;
        let mut bytes = HEADER.to_vec();
        bytes.extend((self.guid.len() as u64).to_le_bytes());
        bytes.extend(self.guid.as_bytes());
        for count in [*step, nodes_c.len(), heat_kw.len()] {
            bytes.extend((count as u64).to_le_bytes());
        }
        bytes.extend(nodes_c.iter().chain(heat_kw).flat_map(|number| number.to_le_bytes()));
        bytes
    }

    /// Reads a state from its bytes.
    ///
    /// # Errors
    /// If the bytes have another format, or are too few or too many.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, String> {
        let rest = bytes.strip_prefix(HEADER).ok_or("the bytes are not a state of an FMU of this version")?;
        let mut reader = Reader(rest);
        let length = reader.count()?;
        let guid = String::from_utf8_lossy(reader.take(length)?).into_owned();
        let (step, nodes, zones) = (reader.count()?, reader.count()?, reader.count()?);
        let state = PlantState { step, nodes_c: reader.numbers(nodes)?, heat_kw: reader.numbers(zones)? };
        if reader.0.is_empty() {
            Ok(Self { guid, state })
        } else {
            Err("there are more bytes than the state has".to_owned())
        }
    }
}

/// The bytes that are not read yet.
struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    fn take(&mut self, length: usize) -> Result<&'a [u8], String> {
        let (taken, rest) = self.0.split_at_checked(length).ok_or("there are fewer bytes than the state has")?;
        self.0 = rest;
        Ok(taken)
    }

    fn word(&mut self) -> Result<[u8; 8], String> {
        let mut word = [0; 8];
        word.copy_from_slice(self.take(8)?);
        Ok(word)
    }

    fn count(&mut self) -> Result<usize, String> {
        usize::try_from(u64::from_le_bytes(self.word()?)).map_err(|error| error.to_string())
    }

    /// Reads a list of numbers. Memory is reserved only after the bytes are known to be there.
    fn numbers(&mut self, count: usize) -> Result<Vec<f64>, String> {
        let bytes = self.take(count.checked_mul(8).ok_or("there are fewer bytes than the state has")?)?;
        let mut numbers = Reader(bytes);
        (0..count).map(|_| numbers.word().map(f64::from_le_bytes)).collect()
    }
}
