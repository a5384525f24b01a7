//! The largest buildings of which dense matrices are made.

use super::{IterativeSettings, Stability};
use crate::control::ControlError;
use crate::lifted::Lifted;

/// The largest number of inputs of a day for which the feedback is designed; its matrices have the square of that many entries.
pub const MOST_UNKNOWNS: usize = 1200;
/// The largest number of temperatures, of zones and walls, for which the matrix inequality is solved. Its time grows with the
/// sixth power of that number: a design of 24 takes some ten seconds.
pub const MOST_LMI_TEMPERATURES: usize = 24;
/// The largest number of temperatures, of zones and walls, for which the linear certificate is computed.
pub const MOST_LINEAR_TEMPERATURES: usize = 256;

/// Refuses a building that is too large for dense matrices.
pub(super) fn check(settings: &IterativeSettings, lifted: &Lifted) -> Result<(), ControlError> {
    let (found, most) = (lifted.size(), MOST_UNKNOWNS);
    if found > most {
        return Err(ControlError::TooManyUnknowns { design: "iterative", found, most });
    }
    let (nodes, zones) = (lifted.model().network().node_count(), lifted.zones());
    let (certificate, most, remedy) = match settings.stability {
        Stability::Lmi | Stability::LeastSquares => {
            ("the matrix inequality", MOST_LMI_TEMPERATURES, "set `stability = \"linear\"`")
        }
        Stability::Linear => ("the linear certificate", MOST_LINEAR_TEMPERATURES, "use the distributed design"),
        Stability::Fixed => return Ok(()),
    };
    if nodes > most {
        return Err(ControlError::TooManyTemperatures { certificate, remedy, zones, nodes, most });
    }
    Ok(())
}
