//! The position of the sun, and its radiation on a tilted plane.
//!
//! ```text
//! I(plane) = I_beam max(0, cos θ) + D(plane) + ρ G (1 − cos β)/2
//! ```
//!
//! with the direct normal radiation I_beam, the angle of incidence θ, the diffuse radiation of the sky D (`perez`), the
//! reflectance ρ of the ground, the global horizontal radiation G, and the tilt β of the plane. Angles of the sun are
//! true angles, without refraction; azimuths are clockwise from north.

mod erbs;
mod perez;
mod plane;
mod position;

pub use erbs::{SplitRadiation, split_global};
pub use plane::{Plane, SkyRadiation};
pub use position::{Site, SunPosition, days_since_2000};
