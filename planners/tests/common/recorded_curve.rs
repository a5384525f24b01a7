//! A curved road and what a vehicle wants there, as text.

use std::sync::Arc;

use interplay_planners::road::Stretch;
use interplay_planners::road::centre_line::LinePolynomial;
use interplay_planners::trajectory::Penalty;
use interplay_planners::trajectory::terms::{FrenetTarget, FrenetTracking, RoadEdge, StopLine};
use interplay_planners::{Body, CentreLine, LaneEnd, Profile, Route};
use serde::{Deserialize, Serialize};

use super::Line;

#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Curve {
    /// Heading of the centre line at its begin \[rad\].
    pub heading: f64,
    /// Per polynomial of the centre line: arc length between its knots, then the coefficients of x and of y over the distance
    /// from the first knot, each from the constant to the fifth power.
    pub line: Vec<[f64; 13]>,
    /// Lateral coordinate of the right edge.
    pub right: Edge,
    /// Lateral coordinate of the left edge.
    pub left: Edge,
}

/// What a vehicle wants on a curved road; the weights are those of its states.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct RoadGoal {
    /// Desired arc length, lateral coordinate and speed.
    pub target: [f64; 3],
    /// Highest permitted speeds at `t = 1…N`, if there are limits.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub permitted: Vec<f64>,
    /// Slip angles at `t = 1…N`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub slips: Vec<f64>,
}

/// A lateral coordinate over the arc length.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Edge {
    /// The same everywhere.
    Constant(f64),
    /// Edge before the end of the lane; end, height and taper of the end.
    LaneEnd([f64; 4]),
    /// Per polynomial: from, to, and the coefficients over the distance from the first knot. Constant before and after them.
    Polynomials(Vec<[f64; 8]>),
}

impl Curve {
    /// The record of the road of an edge term.
    pub fn new(of: &RoadEdge) -> Self {
        let row = |LinePolynomial { length_m, x, y }: LinePolynomial| {
            let mut row = [length_m; 13];
            row[1..7].copy_from_slice(&x);
            row[7..].copy_from_slice(&y);
            row
        };
        Curve {
            heading: of.route.centre.at(0.0).heading_rad,
            line: of.route.centre.polynomials().into_iter().map(row).collect(),
            right: Edge::new(&of.route.right),
            left: Edge::new(&of.route.left),
        }
    }

    pub fn route(&self) -> Arc<Route> {
        let part = |row: &[f64; 13]| LinePolynomial {
            length_m: row[0],
            x: std::array::from_fn(|power| row[1 + power]),
            y: std::array::from_fn(|power| row[7 + power]),
        };
        let parts: Vec<LinePolynomial> = self.line.iter().map(part).collect();
        let centre = CentreLine::from_polynomials(&parts, self.heading).expect("a recorded line");
        Arc::new(Route::curved(centre, self.right.profile(), self.left.profile(), Profile::constant(0.0)))
    }

    pub fn edge(&self, vehicle: usize, body: Body, route: &Arc<Route>) -> RoadEdge {
        let route = Arc::clone(route);
        RoadEdge { vehicle, body, route, penalty: Penalty::ROAD_EDGE }
    }

    /// A line before which a front stays.
    pub fn stop_line(&self, vehicle: usize, body: &Body, route: &Arc<Route>, line: &Line, horizon: usize) -> StopLine {
        StopLine {
            vehicle,
            front_m: body.front_m,
            route: Arc::clone(route),
            lines_m: vec![line.line_m; horizon],
            penalty: line.penalty.into(),
        }
    }
}

impl RoadGoal {
    /// The record of a tracking cost.
    pub fn new(of: &FrenetTracking) -> Self {
        let FrenetTarget { along_m, across_m, speed_mps } = of.target;
        RoadGoal {
            target: [along_m, across_m, speed_mps],
            permitted: of.permitted_mps.clone(),
            slips: of.slips_rad.clone(),
        }
    }

    /// The tracking cost.
    pub fn tracking(&self, vehicle: usize, weights: [f64; 4]) -> FrenetTracking {
        let [along_m, across_m, speed_mps] = self.target;
        FrenetTracking {
            vehicle,
            weights,
            target: FrenetTarget { along_m, across_m, speed_mps },
            permitted_mps: self.permitted.clone(),
            slips_rad: self.slips.clone(),
        }
    }
}

impl Edge {
    fn new(of: &Profile) -> Self {
        if let Some(LaneEnd { end_m, height_m, taper_m }) = of.end() {
            return Edge::LaneEnd([of.value_before_end(0.0), end_m, height_m, taper_m]);
        }
        if of.stretches().is_empty() {
            return Edge::Constant(of.value(0.0));
        }
        let row = |Stretch { from_m, to_m, coefficients: [a, b, c, d, e, f] }: &Stretch| {
            [*from_m, *to_m, *a, *b, *c, *d, *e, *f]
        };
        Edge::Polynomials(of.stretches().iter().map(row).collect())
    }

    fn profile(&self) -> Profile {
        match self {
            Edge::Constant(value) => Profile::constant(*value),
            &Edge::LaneEnd([edge_m, end_m, height_m, taper_m]) => {
                Profile::lane_end(edge_m, LaneEnd { end_m, height_m, taper_m })
            }
            Edge::Polynomials(rows) => {
                let stretch = |&[from_m, to_m, ref coefficients @ ..]: &[f64; 8]| Stretch {
                    from_m,
                    to_m,
                    coefficients: *coefficients,
                };
                let stretches: Vec<Stretch> = rows.iter().map(stretch).collect();
                Profile::from_stretches(&stretches).expect("a recorded edge")
            }
        }
    }
}

/// The centre line and the edges of a curved road, without its lanes.
pub fn curve_alone(route: &Arc<Route>) -> Arc<Route> {
    if route.straight().is_some() {
        return Arc::clone(route);
    }
    let (centre, [right, left]) = (route.centre.clone(), [&route.right, &route.left].map(Profile::clone));
    Arc::new(Route::curved(centre, right, left, Profile::constant(0.0)))
}
