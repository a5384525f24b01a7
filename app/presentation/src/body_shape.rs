//! The shapes that vehicles have from above: the same car in animations and in figures.

use crate::body_style::BodyStyle;
use crate::palette::{Colour, GLASS, TYRE};

/// What a part of a vehicle is painted with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyPaint {
    /// The colour of the vehicle.
    Own,
    /// Windows.
    Glass,
    /// Gaps and tyres.
    Tyre,
}

impl BodyPaint {
    /// Its colour on a vehicle of some colour.
    pub fn colour(self, own: Colour) -> Colour {
        match self {
            BodyPaint::Own => own,
            BodyPaint::Glass => GLASS,
            BodyPaint::Tyre => TYRE,
        }
    }
}

/// A filled part of a vehicle. Places are shares of the body: −1 at the rear and right, 1 at the front and left.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyPart {
    /// The corners, along and across.
    pub ring: Vec<[f64; 2]>,
    /// Radius of the corners, by the width of the body.
    pub radius: f64,
    /// What it is painted with.
    pub paint: BodyPaint,
}

/// A rectangle along and across a body: rear, front, right, left.
pub fn rectangle([rear, front, right, left]: [f64; 4]) -> [[f64; 2]; 4] {
    [[rear, right], [front, right], [front, left], [rear, left]]
}

/// The body of a vehicle, and what lies on it, from below to above.
pub fn body_parts(style: BodyStyle) -> Vec<BodyPart> {
    let part = |ring: &[[f64; 2]], radius, paint| BodyPart { ring: ring.to_vec(), radius, paint };
    let body = |radius| part(&rectangle([-1.0, 1.0, -1.0, 1.0]), radius, BodyPaint::Own);
    match style {
        BodyStyle::Car => {
            // Windows all around a roof.
            let (rear, front) = (-0.62, 0.42);
            let windows =
                [[rear, -0.6], [rear, 0.6], [front - 0.06, 0.84], [front, 0.7], [front, -0.7], [front - 0.06, -0.84]];
            let roof = [[rear + 0.17, -0.62], [rear + 0.17, 0.62], [front - 0.26, 0.68], [front - 0.26, -0.68]];
            vec![body(0.3), part(&windows, 0.14, BodyPaint::Glass), part(&roof, 0.1, BodyPaint::Own)]
        }
        BodyStyle::Van => vec![body(0.12), part(&windscreen([0.62, 0.82], [0.88, 0.78]), 0.06, BodyPaint::Glass)],
        BodyStyle::Lorry => vec![
            body(0.12),
            part(&windscreen([0.86, 0.95], [0.9, 0.86]), 0.06, BodyPaint::Glass),
            part(&rectangle([0.66, 0.69, -1.0, 1.0]), 0.0, BodyPaint::Tyre),
        ],
        BodyStyle::Bicycle => vec![
            part(&rectangle([-1.0, 1.0, -0.12, 0.12]), 0.06, BodyPaint::Tyre),
            part(&rectangle([-0.28, 0.12, -0.8, 0.8]), 0.25, BodyPaint::Own),
        ],
    }
}

/// A windscreen between two places along the body, `across` at its rear and at its front edge.
fn windscreen([rear, front]: [f64; 2], across: [f64; 2]) -> [[f64; 2]; 4] {
    [[rear, -across[0]], [rear, across[0]], [front, across[1]], [front, -across[1]]]
}
