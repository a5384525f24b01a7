//! What the violation of a soft row costs.

/// What a violation `s ≥ 0` costs: `linear·s + quadratic·s²`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Penalty {
    /// Weight `linear` of the violation `s`.
    pub linear: f64,
    /// Weight `quadratic` of the squared violation `s²`.
    pub quadratic: f64,
}

impl From<[f64; 2]> for Penalty {
    /// From the weights of `s` and `s²`.
    fn from([linear, quadratic]: [f64; 2]) -> Penalty {
        Penalty { linear, quadratic }
    }
}

impl From<Penalty> for [f64; 2] {
    fn from(penalty: Penalty) -> [f64; 2] {
        [penalty.linear, penalty.quadratic]
    }
}

impl Penalty {
    /// The exact penalty of the safety rows, on `1 − d²`.
    pub const EXACT: Penalty = Penalty { linear: 1e3, quadratic: 1e3 };

    /// The exact penalty of the road-edge rows of a 1/10 scale car, on metres beyond the edge.
    ///
    /// A plan that can keep either the road or its distance trades metres for `1 − d²`, which falls by up to `2/b_s` (4 to 6)
    /// a metre. With 10³ for both, as in the source, an ego whose partner hesitates drives up to 80 mm off the road to come
    /// out of an ellipse; from 2·10³ on it stays on the road (`scenarios` `intersection/late` with `hesitation_s`).
    pub const ROAD_EDGE: Penalty = Penalty { linear: 2e3, quadratic: 2e3 };

    /// The penalty of the lines of the own lane of a vehicle whose lengths are `scale` times those of a 1/10 scale car: firm, and small
    /// beside those of safety and of the road's edges.
    pub fn lane_line(scale: f64) -> Penalty {
        Penalty { linear: 100.0 / scale, quadratic: 100.0 / (scale * scale) }
    }

    /// [`Penalty::ROAD_EDGE`] of a vehicle whose lengths are `scale` times those of a 1/10 scale car.
    pub fn road_edge(scale: f64) -> Penalty {
        let Penalty { linear, quadratic } = Penalty::ROAD_EDGE;
        Penalty { linear: linear / scale, quadratic: quadratic / (scale * scale) }
    }

    /// A hinge: no cost inside, `weight·s²` beyond (the human driver's discomfort).
    pub fn hinge(weight: f64) -> Penalty {
        Penalty { linear: 0.0, quadratic: weight }
    }

    /// Whether the penalty begins with a slope, so that with a weight above its multiplier the row holds whenever it can: a
    /// constraint, and not a price of coming near.
    pub fn is_exact(&self) -> bool {
        self.linear > 0.0
    }

    /// Cost of a row of value `c`, violated by `max(0, −c)`.
    pub fn cost(&self, value: f64) -> f64 {
        let violation = (-value).max(0.0);
        violation * (self.linear + self.quadratic * violation)
    }
}
