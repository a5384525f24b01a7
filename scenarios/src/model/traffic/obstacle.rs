//! The obstacles of a scenario.

use interplay_planners::Body;
use schemars::{JsonSchema, Schema};
use serde::{Deserialize, Serialize};

/// The kind of an obstacle.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(transform = one_of_the_words)]
pub enum ObstacleKind {
    /// A car that is parked, 4.5 m × 1.8 m.
    #[default]
    ParkedCar,
    /// A van that is parked, 6 m × 2 m.
    ParkedVan,
    /// A traffic cone, a circle of 0.4 m.
    Cone,
    /// A wall, 10 m × 0.3 m.
    Wall,
    /// Works, 4 m × 2 m.
    Works,
    /// A kind of another crate, by its word; the registry declares it ([`DeclaredObstacle`]).
    #[serde(untagged)]
    #[schemars(skip)]
    Declared(String),
}

/// The words of the schema exclude each other: the variant of other crates, which accepts any word, is not among them.
fn one_of_the_words(schema: &mut Schema) {
    let entries = std::mem::take(schema.ensure_object()).into_iter();
    let renamed = entries.map(|(key, value)| (if key == "anyOf" { "oneOf".to_owned() } else { key }, value));
    *schema.ensure_object() = renamed.collect();
}

/// A kind of obstacle that another crate provides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeclaredObstacle {
    /// The word for this kind in a scenario file: small letters, digits and hyphens.
    pub kind: &'static str,
    /// Its description in the schema.
    pub about: &'static str,
    /// The usual length and width of a real one \[m\].
    pub size_m: [f64; 2],
    /// Whether its usual shape is a circle.
    pub is_round: bool,
}

impl ObstacleKind {
    /// The usual length and width of a real one \[m\], and whether it is a circle.
    pub(crate) fn shape(&self, declared: &[DeclaredObstacle]) -> ([f64; 2], bool) {
        match self {
            ObstacleKind::ParkedCar => ([4.5, 1.8], false),
            ObstacleKind::ParkedVan => ([6.0, 2.0], false),
            ObstacleKind::Cone => ([0.4, 0.4], true),
            ObstacleKind::Wall => ([10.0, 0.3], false),
            ObstacleKind::Works => ([4.0, 2.0], false),
            ObstacleKind::Declared(word) => {
                let found = declared.iter().find(|declared| declared.kind == word);
                // The schema has refused other words.
                found.map_or(([1.0, 1.0], false), |declared| (declared.size_m, declared.is_round))
            }
        }
    }
}

/// An obstacle: its kind and its shape. It belongs to a vehicle without a driver.
#[derive(Clone, Debug, PartialEq)]
pub struct ObstacleForm {
    /// Its kind.
    pub kind: ObstacleKind,
    /// Its outline around its middle.
    pub outline: Outline,
}

/// Smaller turns are treated as zero \[rad\].
const ROUNDING: f64 = 1e-9;

/// The outline of an obstacle, around its middle.
#[derive(Clone, Debug, PartialEq)]
pub enum Outline {
    /// A box of a length and a width \[m\].
    Box {
        /// To the front \[m\].
        length_m: f64,
        /// Across \[m\].
        width_m: f64,
    },
    /// A circle \[m\].
    Circle {
        /// Its radius \[m\].
        radius_m: f64,
    },
    /// A convex polygon: corners to the front and to the left, counter-clockwise \[m\].
    Polygon {
        /// Its corners \[m\].
        corners_m: Vec<[f64; 2]>,
    },
}

impl Outline {
    /// The smallest body around the outline, at a scale ([`Body::scale`]).
    pub fn body(&self, scale: f64) -> Body {
        let (front_m, rear_m, width_m) = match self {
            Outline::Box { length_m, width_m } => (0.5 * length_m, 0.5 * length_m, *width_m),
            Outline::Circle { radius_m } => (*radius_m, *radius_m, 2.0 * radius_m),
            Outline::Polygon { corners_m } => {
                let most = |of: fn(&[f64; 2]) -> f64| corners_m.iter().map(of).fold(0.0, f64::max);
                (most(|at| at[0]), most(|at| -at[0]), 2.0 * most(|at| at[1].abs()))
            }
        };
        // An obstacle never moves by itself, so any axles within its body are valid.
        let (front_axle_m, rear_axle_m) = (0.6 * front_m.max(1e-3), 0.6 * rear_m.max(1e-3));
        Body { front_m, rear_m, width_m, front_axle_m, rear_axle_m, scale }
    }

    /// The outline turned about its middle, counter-clockwise \[rad\].
    pub(crate) fn turned(self, angle_rad: f64) -> Outline {
        let (sin, cos) = libm::sincos(angle_rad);
        let is_same = sin.abs() < ROUNDING && (cos > 0.0 || matches!(self, Outline::Box { .. }));
        if is_same || matches!(self, Outline::Circle { .. }) {
            return self;
        }
        let turn = |[x, y]: [f64; 2]| [cos * x - sin * y, sin * x + cos * y];
        Outline::Polygon { corners_m: self.corners_m().into_iter().map(turn).collect() }
    }

    /// Corners of the outline, counter-clockwise, as coordinates to the front and to the left \[m\]; a circle has sixteen.
    pub fn corners_m(&self) -> Vec<[f64; 2]> {
        match self {
            Outline::Box { length_m, width_m } => {
                let (x, y) = (0.5 * length_m, 0.5 * width_m);
                vec![[x, -y], [x, y], [-x, y], [-x, -y]]
            }
            Outline::Circle { radius_m } => {
                let corner = |index: u32| {
                    let (sin, cos) = libm::sincos(f64::from(index) * std::f64::consts::PI / 8.0);
                    [radius_m * cos, radius_m * sin]
                };
                (0..16).map(corner).collect()
            }
            Outline::Polygon { corners_m } => corners_m.clone(),
        }
    }
}
