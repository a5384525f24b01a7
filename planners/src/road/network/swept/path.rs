//! The path of the rear axle of a long body through a turn.
//!
//! Decided are its lateral positions `n_k` beside the line of its lanes, at arc lengths a tenth of a wheelbase `L` apart; before and behind
//! the turn they are zero. The body points where its rear axle goes. With the angle `α_k` from each place to the next, and the curvature
//! `κ_k` between them, the path minimises by Gauss and Newton (Levenberg and Marquardt)
//!
//! ```text
//! Σ (L² dκ/ds)² + w_n (n/W)² + w_l Σ (lane line crossed by/W)₊² + w_e Σ (edge crossed by/W)₊² + w_κ (L (|κ| − κ_max))₊²
//! ```
//!
//! over points of both sides of the body, with the lane width `W` and `κ_max = tan δ_max/L`. The Hessian has seven diagonals.

use super::super::super::centre_line::{CentreLine, CentreLineError, FrenetExpansion};
use super::area::Area;
use super::turner::{SPACING, Turner};
use crate::vehicle::Body;

/// Weights of deviation, lane lines, edges and curvature.
const DEVIATION: f64 = 0.1;
const LANE_LINE: f64 = 1.0;
const EDGE: f64 = 30.0;
const CURVATURE: f64 = 300.0;
/// Edges and curvature become harder by these factors, one after the other.
pub(super) const HARDNESS: [f64; 4] = [1.0, 10.0, 100.0, 1000.0];
/// Edges are kept by this share of the lane width.
const MARGIN: f64 = 0.09;
/// The path uses this share of the largest curvature.
const CURVATURE_SHARE: f64 = 0.95;
/// Most steps of each, and the relative improvement at which they end.
const MAX_STEPS: usize = 40;
const ENOUGH: f64 = 1e-6;
/// Damping: at first, and by which factors it changes.
const DAMPING: f64 = 1e-3;
const MAX_DAMPING: f64 = 1e6;
/// Half of the diagonals of the Hessian, without the main one.
const BAND: usize = 3;

/// A path through one turn.
pub(super) struct Path<'a> {
    line: &'a CentreLine,
    /// Where it leaves the line, and where it comes back to it \[m\].
    pub window_m: [f64; 2],
    /// Distance of its places on the line \[m\].
    pub spacing_m: f64,
    body: Body,
    max_1pm: f64,
    width_m: f64,
    area: &'a Area,
    /// Position and normal of the line at each place.
    frame: Vec<([f64; 2], [f64; 2])>,
    across_m: Vec<f64>,
}

/// A sum of squares near a point: gradient, and lower diagonals of the Gauss-Newton matrix.
struct Model {
    cost: f64,
    gradient: Vec<f64>,
    bands: Vec<[f64; BAND + 1]>,
}

impl Model {
    fn new(count: usize) -> Model {
        Model { cost: 0.0, gradient: vec![0.0; count], bands: vec![[0.0; BAND + 1]; count] }
    }

    /// Adds `w r²/2` with the derivatives of `r` over the decisions from `first` on.
    fn add(&mut self, weight: f64, residual: f64, first: usize, slopes: &[f64]) {
        self.cost += 0.5 * weight * residual * residual;
        for (i, slope) in slopes.iter().enumerate() {
            self.gradient[first + i] += weight * residual * slope;
            for (j, other) in slopes[..=i].iter().enumerate() {
                self.bands[first + i][i - j] += weight * slope * other;
            }
        }
    }

    /// The step that solves `(H + d diag H) x = −g` at places from `fixed` on to as many before the end, by Cholesky's method.
    fn step(&self, damping: f64, fixed: usize) -> Vec<f64> {
        let count = self.gradient.len();
        let mut lower = self.bands.clone();
        for band in &mut lower {
            band[0] += damping * band[0] + 1e-12;
        }
        let is_free = |index: usize| (fixed..count - fixed).contains(&index);
        let mut x: Vec<f64> = self.gradient.iter().map(|slope| -slope).collect();
        for i in 0..count {
            if !is_free(i) {
                (lower[i], x[i]) = ([0.0; BAND + 1], 0.0);
                lower[i][0] = 1.0;
            }
            for back in (0..=BAND.min(i)).rev() {
                let j = i - back;
                if back > 0 && !is_free(j) {
                    lower[i][back] = 0.0;
                }
                let shared = (back + 1..=BAND.min(i)).filter(|k| k - back <= BAND.min(j));
                let sum: f64 = shared.map(|k| lower[i][k] * lower[j][k - back]).sum();
                lower[i][back] -= sum;
                lower[i][back] = if back > 0 { lower[i][back] / lower[j][0] } else { lower[i][0].max(1e-12).sqrt() };
            }
            let sum: f64 = (1..=BAND.min(i)).map(|back| lower[i][back] * x[i - back]).sum();
            x[i] = (x[i] - sum) / lower[i][0];
        }
        for i in (0..count).rev() {
            let sum: f64 = (1..=BAND.min(count - 1 - i)).map(|ahead| lower[i + ahead][ahead] * x[i + ahead]).sum();
            x[i] = (x[i] - sum) / lower[i][0];
        }
        x
    }
}

/// Decisions at either end that stay zero, so that position and direction there are those of the line.
const FIXED: usize = 3;

impl<'a> Path<'a> {
    pub fn new(
        line: &'a CentreLine,
        window_m: [f64; 2],
        turner: &Turner,
        area: &'a Area,
        hardness: &[f64],
    ) -> Path<'a> {
        let Turner { body, steering_max_rad } = *turner;
        let count = ((window_m[1] - window_m[0]) / (SPACING * body.wheelbase_m())).ceil().max(10.0) as usize;
        let spacing_m = (window_m[1] - window_m[0]) / count as f64;
        let frame = (0..=count).map(|place| {
            let at = line.at(window_m[0] + spacing_m * place as f64);
            let (sin, cos) = libm::sincos(at.heading_rad);
            (at.position, [-sin, cos])
        });
        let frame = frame.collect();
        let max_1pm = CURVATURE_SHARE * libm::tan(steering_max_rad) / body.wheelbase_m();
        let mut path = Path {
            line,
            window_m,
            spacing_m,
            body,
            max_1pm,
            width_m: area.width_m,
            area,
            frame,
            across_m: vec![0.0; count + 1],
        };
        hardness.iter().for_each(|hardness| path.improve(*hardness));
        path
    }

    fn improve(&mut self, hardness: f64) {
        let mut damping = DAMPING;
        let mut model = self.model(&self.across_m, hardness);
        for _ in 0..MAX_STEPS {
            let step = model.step(damping, FIXED);
            let next: Vec<f64> = self.across_m.iter().zip(&step).map(|(across_m, step)| across_m + step).collect();
            let tried = self.model(&next, hardness);
            if tried.cost < model.cost {
                let is_enough = model.cost - tried.cost < ENOUGH * model.cost;
                (self.across_m, model, damping) = (next, tried, 0.3 * damping);
                if is_enough {
                    break;
                }
            } else {
                damping *= 8.0;
                if damping > MAX_DAMPING {
                    break;
                }
            }
        }
    }

    /// Where the rear axle is at each place \[m\].
    fn places(&self, across_m: &[f64]) -> Vec<[f64; 2]> {
        let place = |((at, normal), across_m): (&([f64; 2], [f64; 2]), &f64)| {
            [at[0] + across_m * normal[0], at[1] + across_m * normal[1]]
        };
        self.frame.iter().zip(across_m).map(place).collect()
    }

    /// The line of the mass centre of the body along the path, from one end of the window to the other.
    ///
    /// # Errors
    /// Those of [`CentreLine::through_towards`].
    pub fn line_of_mass_centre(&self) -> Result<CentreLine, CentreLineError> {
        let places = self.places(&self.across_m);
        let rear_m = self.body.rear_axle_m;
        let ahead = |index: usize| {
            let [from, to] = [places[index - 1], places[index + 1]];
            let length_m = libm::hypot(to[0] - from[0], to[1] - from[1]);
            [0, 1].map(|axis| places[index][axis] + rear_m * (to[axis] - from[axis]) / length_m)
        };
        let [from_m, to_m] = self.window_m;
        let ends = [from_m, to_m].map(|along_m| self.line.position(along_m, 0.0));
        let inside = (1..places.len() - 1).map(ahead).filter(|point| {
            let along_m = self.line.project(*point, None).along_m;
            (from_m + self.spacing_m..to_m - self.spacing_m).contains(&along_m)
        });
        let points: Vec<[f64; 2]> = [ends[0]].into_iter().chain(inside).chain([ends[1]]).collect();
        CentreLine::through_towards(&points, [from_m, to_m].map(|along_m| Some(self.line.at(along_m).heading_rad)))
    }

    /// The cost of lateral positions, and its model there.
    fn model(&self, across_m: &[f64], hardness: f64) -> Model {
        let (places, last) = (self.places(across_m), across_m.len() - 1);
        let (wheelbase_m, mut model) = (self.body.wheelbase_m(), Model::new(across_m.len()));
        let share = self.spacing_m / wheelbase_m;
        let chord = |from: usize, to: usize| {
            let apart = [places[to][0] - places[from][0], places[to][1] - places[from][1]];
            let length_m = libm::hypot(apart[0], apart[1]);
            let direction = apart.map(|part| part / length_m);
            // The derivative of the angle of the chord over the lateral position of an end, times its sign.
            let slope = |end: usize| {
                let normal = self.frame[end].1;
                (direction[0] * normal[1] - direction[1] * normal[0]) / length_m
            };
            (length_m, direction, [-slope(from), slope(to)])
        };
        // Curvature at place `k`: value, and derivatives over `n_{k−1}`, `n_k` and `n_{k+1}`.
        let curvature = |k: usize| {
            let ((before_m, a, [da, db]), (after_m, b, [dc, dd])) = (chord(k - 1, k), chord(k, k + 1));
            let length_m = 0.5 * (before_m + after_m);
            let turn_rad = libm::atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
            (turn_rad / length_m, [-da, dc - db, dd].map(|slope| slope / length_m))
        };
        let mut before = None;
        for k in 1..last {
            let (value_1pm, slopes) = curvature(k);
            if let Some((last_1pm, last_slopes)) = before.replace((value_1pm, slopes)) {
                let scale = wheelbase_m * wheelbase_m / self.spacing_m;
                let mut change = [0.0; 4];
                for i in 0..3 {
                    change[i] -= scale * last_slopes[i];
                    change[i + 1] += scale * slopes[i];
                }
                model.add(share, scale * (value_1pm - last_1pm), k - 2, &change);
            }
            let beyond_1pm = value_1pm.abs() - self.max_1pm;
            if beyond_1pm > 0.0 {
                let slopes = slopes.map(|slope| wheelbase_m * value_1pm.signum() * slope);
                model.add(share * hardness * CURVATURE, wheelbase_m * beyond_1pm, k - 1, &slopes);
            }
            model.add(share * DEVIATION, across_m[k] / self.width_m, k, &[1.0 / self.width_m]);
            let (_, direction, [back, ahead]) = chord(k - 1, k + 1);
            self.add_body(&mut model, hardness, k, places[k], direction, [back, ahead]);
        }
        model
    }

    /// What points of both sides of the body cost at place `k`, from which it points in a direction, whose angle changes with the lateral
    /// positions before and behind.
    fn add_body(
        &self,
        model: &mut Model,
        hardness: f64,
        k: usize,
        [x, y]: [f64; 2],
        [cos, sin]: [f64; 2],
        turns: [f64; 2],
    ) {
        let Body { front_m, rear_m, width_m, rear_axle_m, .. } = self.body;
        let (ahead_m, wheelbase_m) = (front_m + rear_axle_m, self.body.wheelbase_m());
        let along_m = self.window_m[0] + self.spacing_m * k as f64;
        let share = self.spacing_m / wheelbase_m;
        for a in [rear_axle_m - rear_m, 0.0, 0.5 * wheelbase_m, wheelbase_m, ahead_m] {
            for b in [-0.5 * width_m, 0.5 * width_m] {
                let arm = [a * cos - b * sin, a * sin + b * cos];
                let at = self.line.project([x + arm[0], y + arm[1]], Some(along_m + a));
                let (road_sin, road_cos) = libm::sincos(at.heading_rad);
                let stretch = (1.0 - at.curvature_1pm * at.across_m).max(FrenetExpansion::MIN_STRETCH);
                let (side, sign) = if b < 0.0 { (0, -1.0) } else { (1, 1.0) };
                let half_m = 0.5 * self.width_m;
                let [edge_m, edge_slope] = self.area.edge_m(side, at.along_m).unwrap_or([sign * half_m, 0.0]);
                let lines =
                    [(LANE_LINE, half_m, 0.0), (hardness * EDGE, sign * edge_m - MARGIN * self.width_m, edge_slope)];
                for (weight, line_m, slope) in lines {
                    let beyond_m = sign * at.across_m - line_m;
                    if beyond_m > 0.0 {
                        let across = |[x, y]: [f64; 2]| {
                            road_cos * y - road_sin * x - slope / stretch * (road_cos * x + road_sin * y)
                        };
                        let (shift, turn) = (across(self.frame[k].1), across([-arm[1], arm[0]]));
                        let slopes = [turn * turns[0], shift, turn * turns[1]].map(|slope| sign * slope / self.width_m);
                        model.add(share * weight, beyond_m / self.width_m, k - 1, &slopes);
                    }
                }
            }
        }
    }
}
