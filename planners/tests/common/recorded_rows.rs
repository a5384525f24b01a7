//! Rows and costs of a recorded problem.
#![allow(dead_code, reason = "each binary uses its own part")]

use interplay_planners::SafetyEllipse;
use interplay_planners::trajectory::Term;
use interplay_planners::trajectory::terms::{
    DistanceCost, DistancePrice, KeepOut, MeanSpeed, Persuasion, Separation, SpeedMeasure,
};
use interplay_planners::vehicle::OrientedEllipse;
use serde::{Deserialize, Serialize};

/// A line that a front stays before.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub struct Line {
    /// Where it is along the road \[m\].
    pub line_m: f64,
    /// Linear and quadratic weight.
    pub penalty: [f64; 2],
}

/// The cost of distances from a moving centre.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Distance {
    /// Centres at `t = 1…N`.
    pub centres: Vec<[f64; 2]>,
    /// `M`: xx, xy, yy, at `t = 1…N`, or one for all.
    pub metrics: Vec<[f64; 3]>,
    pub price: Price,
}

/// `φ(ω)`.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Price {
    Linear(f64),
    /// Base, loyalty, aversion.
    Exact([f64; 3]),
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub struct Mean {
    pub bounds: [Option<f64>; 2],
    /// Linear and quadratic weight.
    pub penalty: [f64; 2],
}

#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Ellipse {
    /// Centres at `t = 1…N`.
    pub centres: Vec<[f64; 2]>,
    /// Direction of the long axis, half axes along and across.
    pub shape: [f64; 3],
    /// Directions of the long axis at `t = 1…N` where they differ \[rad\].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub headings: Vec<f64>,
    /// Linear and quadratic weight.
    pub penalty: [f64; 2],
}

#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Apart {
    /// The vehicle that keeps out, and the one around which.
    pub pair: [usize; 2],
    /// Direction of the long axis, half axes along and across.
    pub shape: [f64; 3],
    /// Directions of the long axis at `t = 1…N` where they differ \[rad\].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub headings: Vec<f64>,
    /// Linear and quadratic weight.
    pub penalty: [f64; 2],
}

#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct PersuasionRow {
    /// Reference to stay near at `t = 0…N−1`.
    pub toward: Vec<[f64; 2]>,
    /// Reference to keep away from at `t = 0…N−1`.
    pub away: Vec<[f64; 2]>,
    /// `α`.
    pub strength: f64,
    /// Linear and quadratic weight.
    pub penalty: [f64; 2],
}

pub fn shape(of: &OrientedEllipse) -> [f64; 3] {
    [of.heading_rad(), of.shape().along_m, of.shape().across_m]
}

pub fn ellipse([heading_rad, along_m, across_m]: [f64; 3]) -> OrientedEllipse {
    SafetyEllipse { along_m, across_m }.oriented(heading_rad)
}

/// The directions of ellipses, if they differ.
pub fn headings(of: &[OrientedEllipse]) -> Vec<f64> {
    let is_one = of.windows(2).all(|pair| pair[0] == pair[1]);
    of.iter().filter(|_| !is_one).map(OrientedEllipse::heading_rad).collect()
}

pub fn ellipses(shape: [f64; 3], headings: &[f64], count: usize) -> Vec<OrientedEllipse> {
    let turned = |stage| ellipse([*headings.get(stage).unwrap_or(&shape[0]), shape[1], shape[2]]);
    (0..count).map(turned).collect()
}

impl Ellipse {
    pub fn new(of: &KeepOut) -> Self {
        Ellipse {
            centres: of.centres.clone(),
            shape: shape(&of.ellipses[0]),
            headings: headings(&of.ellipses),
            penalty: of.penalty.into(),
        }
    }

    pub fn keep_out(&self, vehicle: usize) -> KeepOut {
        let ellipses = ellipses(self.shape, &self.headings, self.centres.len());
        KeepOut { vehicle, centres: self.centres.clone(), ellipses, penalty: self.penalty.into() }
    }
}

impl Distance {
    pub fn new(of: &DistanceCost) -> Self {
        let price = match of.price {
            DistancePrice::Linear { weight } => Price::Linear(weight),
            DistancePrice::Exact { base, loyalty, aversion } => Price::Exact([base, loyalty, aversion]),
        };
        let is_one = of.metrics.windows(2).all(|pair| pair[0] == pair[1]);
        let metrics = if is_one { of.metrics[..1].to_vec() } else { of.metrics.clone() };
        Distance { centres: of.centres.clone(), metrics, price }
    }

    pub fn distance_cost(&self, vehicle: usize) -> DistanceCost {
        let price = match self.price {
            Price::Linear(weight) => DistancePrice::Linear { weight },
            Price::Exact([base, loyalty, aversion]) => DistancePrice::Exact { base, loyalty, aversion },
        };
        let metrics = self.metrics.iter().cycle().take(self.centres.len()).copied().collect();
        DistanceCost { vehicle, centres: self.centres.clone(), metrics, price }
    }
}

impl Mean {
    pub fn mean_speed(&self) -> MeanSpeed {
        let [lower_mps, upper_mps] = self.bounds;
        MeanSpeed { measure: SpeedMeasure::Speeds, lower_mps, upper_mps, penalty: self.penalty.into() }
    }
}

impl Apart {
    pub fn from_term(term: &Term) -> Option<Self> {
        let Term::Separation(of) = term else { return None };
        Some(Apart {
            pair: [of.vehicle, of.from],
            shape: shape(&of.ellipses[0]),
            headings: headings(&of.ellipses),
            penalty: of.penalty.into(),
        })
    }

    pub fn separation(&self, horizon: usize) -> Separation {
        Separation {
            vehicle: self.pair[0],
            from: self.pair[1],
            ellipses: ellipses(self.shape, &self.headings, horizon),
            penalty: self.penalty.into(),
        }
    }
}

impl PersuasionRow {
    pub fn from_term(term: &Term) -> Option<Self> {
        let Term::Persuasion(Persuasion { toward, away, strength, penalty, .. }) = term.clone() else { return None };
        Some(PersuasionRow { toward, away, strength, penalty: penalty.into() })
    }

    pub fn persuasion(&self) -> Persuasion {
        Persuasion {
            vehicle: 0,
            toward: self.toward.clone(),
            away: self.away.clone(),
            strength: self.strength,
            penalty: self.penalty.into(),
        }
    }
}
