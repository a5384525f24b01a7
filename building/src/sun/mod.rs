//! The position of the sun, and its radiation on a tilted plane.
//!
//! ```text
//! I(plane) = I_beam max(0, cos θ) + D(plane) + ρ G (1 − cos β)/2
//! ```
//!
//! with the direct normal radiation I_beam, the angle of incidence θ, the diffuse radiation of the sky D (`perez`), the
//! reflectance ρ of the ground, the global horizontal radiation G, and the tilt β of the plane. Angles of the sun are
//! true angles, without refraction; azimuths are clockwise from north.

mod perez;
mod position;

pub use perez::{SplitRadiation, split_global};
pub use position::{Plane, Site, SkyRadiation, SunPosition, days_since_2000};
