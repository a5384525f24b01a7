//! The lowest decay rate that a feedback can reach, and the rate that the design uses.
//!
//! A feedback of zone temperatures on the heat of zones leaves the columns of walls in A − BK as they are. With the
//! temperatures of the zones before those of the walls,
//!
//! ```text
//! A − B [K 0] = ⎡ A_zz − B_z K   A_zw ⎤
//!               ⎣ A_wz − B_w K   A_ww ⎦
//! ```
//!
//! Neither certificate proves a rate below the spectral radius of `A_ww`, the rate at which walls settle between zones whose
//! temperatures are held. In the matrix inequality, F has no entries from walls to zones, so that its rows and columns of
//! walls are the same inequality for `A_ww` alone. In the linear one, the rows of walls contain those for `|A_ww|`. The floor is
//! tight: on random networks the inequality reaches it to 4·10⁻³ and the linear one to 10⁻²
//! (`certificates_reach_the_floor_that_walls_set`).

use super::{IterativeSettings, Stability};
use crate::control::ControlError;
use crate::control::stability::spectral_radius;
use crate::discretise::Model;

/// The default decay rate where walls allow it.
const DEFAULT_DECAY: f64 = 0.7;
/// Share of the way from the floor to 1 at which the default lies otherwise. Chosen: nearer to the floor the semidefinite
/// programme of walls above 10,000 kJ/K becomes ill-conditioned, and the cost of the feedback rises.
const DEFAULT_MARGIN_SHARE: f64 = 0.2;

/// The lowest decay rate per step that a feedback can reach: the spectral radius of the walls' block of A; 0 without
/// walls that store heat. Takes time proportional to the cube of the number of walls.
pub fn floor(model: &Model) -> f64 {
    let (nodes, zones) = (model.network().node_count(), model.network().zone_count());
    let walls = nodes - zones;
    if walls == 0 {
        0.0
    } else {
        spectral_radius(&model.state_matrix().view((zones, zones), (walls, walls)).into_owned())
    }
}

/// The decay rate if the settings state none.
pub fn default(floor: f64) -> f64 {
    (floor + DEFAULT_MARGIN_SHARE * (1.0 - floor)).max(DEFAULT_DECAY)
}

/// The decay rate that the settings state, or the default.
///
/// # Errors
/// [`ControlError::DecayBelowFloor`] if the stated one is not above the floor.
pub fn chosen(settings: &IterativeSettings, model: &Model) -> Result<f64, ControlError> {
    if settings.stability == Stability::Fixed {
        return Ok(settings.decay.unwrap_or(DEFAULT_DECAY));
    }
    let floor = floor(model);
    match settings.decay {
        Some(decay) if decay <= floor => Err(ControlError::DecayBelowFloor { decay, floor, works: default(floor) }),
        Some(decay) => Ok(decay),
        None => Ok(default(floor)),
    }
}
