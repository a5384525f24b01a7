//! The kinds of driver that an observed one may be.

/// The safety weights of the hypothesised humans, from tough to nice. Weights between them need no hypothesis of their own:
/// their plans nearly coincide with one of these.
pub(super) const SAFETY_WEIGHTS: [f64; 3] = [0.0, 8.0, 50.0];

/// Prior probability that a driver is like our human driver, of whatever style and with whatever wish.
pub(super) const HUMAN_PRIOR: f64 = 0.9;

/// A kind of driver; the humans come in the order of [`SAFETY_WEIGHTS`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DriverModel {
    /// Our human driver with safety weight 0.
    Tough,
    /// Our human driver with safety weight 8.
    Normal,
    /// Our human driver with safety weight 50.
    Nice,
    /// The intelligent driver model.
    Idm,
    /// None of these: it goes on at constant velocity, with large errors.
    Unknown,
}

impl DriverModel {
    /// All kinds, in the order in which probabilities are listed.
    pub const ALL: [DriverModel; 5] =
        [DriverModel::Tough, DriverModel::Normal, DriverModel::Nice, DriverModel::Idm, DriverModel::Unknown];

    /// Its place in [`DriverModel::ALL`].
    pub(super) fn index(self) -> usize {
        self as usize
    }

    /// The kind in words, as part of a sentence.
    pub fn name(self) -> &'static str {
        match self {
            DriverModel::Tough => "tough",
            DriverModel::Normal => "normal",
            DriverModel::Nice => "nice",
            DriverModel::Idm => "an IDM driver",
            DriverModel::Unknown => "none of the known drivers",
        }
    }

    /// Whether it takes notice of vehicles outside its own lane, as far as is known.
    pub fn can_be_asked(self) -> bool {
        match self {
            DriverModel::Tough | DriverModel::Normal | DriverModel::Nice => true,
            DriverModel::Idm | DriverModel::Unknown => false,
        }
    }
}
