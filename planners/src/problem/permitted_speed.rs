//! How fast a driver may go along its road, and comes up to a line: speed limits, curves and comfortable braking.

use crate::{Agent, Limits, Scene};

/// Drivers brake for a speed limit with this share of their strongest braking.
const COMFORTABLE_BRAKING_SHARE: f64 = 0.4;

/// And with this share of the braking that they bear, so that there is room to brake later or harder.
const BORNE_BRAKING_SHARE: f64 = 0.7;

/// Drivers take curves with this share of their largest lateral acceleration.
const COMFORTABLE_LATERAL_SHARE: f64 = 0.5;

/// And with this share of the lateral acceleration that they bear.
const IN_CURVES_SHARE: f64 = 0.9;

/// Of an acceleration that ends evenly over a step remains this share of its effect.
const ROLLING_ON_SHARE: f64 = 0.5;

/// Drivers come up to a line with this share of their strongest acceleration.
const COMFORTABLE_ACCELERATION_SHARE: f64 = 0.5;

/// Braking with which a driver lets a vehicle in that merges, until it is so much slower than it wants, of real vehicles \[m/s²\], \[m/s\].
pub(crate) const COURTESY_MPS2: f64 = 1.0;
pub(crate) const COURTESY_MPS: f64 = 3.0;

/// No cap on the speed of a 1/10 scale car is lower \[m/s\].
const CREEPING_MPS: f64 = 0.03;

impl Agent {
    /// The highest permitted speeds at arc lengths of its route, braking comfortably for lower limits and curves ahead; infinite
    /// where nothing limits it, and empty if nothing does anywhere \[m/s\].
    pub(crate) fn permitted_speeds_mps(&self, along_m: &[f64]) -> Vec<f64> {
        let permitted = |along_m: &f64| self.permitted_speed_mps(*along_m).unwrap_or(f64::INFINITY);
        let permitted: Vec<f64> = along_m.iter().map(permitted).collect();
        if permitted.iter().any(|speed_mps| speed_mps.is_finite()) { permitted } else { Vec::new() }
    }

    /// The highest permitted speed at an arc length of its route, braking comfortably for lower limits and curves ahead; none
    /// without limits \[m/s\].
    pub(crate) fn permitted_speed_mps(&self, along_m: f64) -> Option<f64> {
        let braking_mps2 = self.comfortable_braking_mps2();
        let permitted_mps = self.route.permitted_speed_mps(along_m, braking_mps2);
        let of_tyres = self.limits.lateral_acceleration_max_mps2.map(|most| COMFORTABLE_LATERAL_SHARE * most);
        let borne = self.limits.comfort.map(|comfort| IN_CURVES_SHARE * comfort.lateral_acceleration_mps2);
        let lateral_mps2 = of_tyres.into_iter().chain(borne).min_by(f64::total_cmp);
        let in_curves_mps = lateral_mps2.and_then(|most| self.route.curve_speed_mps(along_m, most, braking_mps2));
        permitted_mps.into_iter().chain(in_curves_mps).min_by(f64::total_cmp)
    }

    /// The largest acceleration of a step at an arc length of its route after which it is not faster than permitted where it then
    /// is; none without limits \[m/s²\].
    ///
    /// At a speed `v` above the permitted `v_p` it is at least `−b (v/v_p)²`, with the comfortable braking `b` that `v_p` is made of.
    pub(crate) fn permitted_acceleration_mps2(&self, along_m: f64, speed_mps: f64, step_s: f64) -> Option<f64> {
        let permitted_mps = self.permitted_speed_mps(along_m + speed_mps * step_s)?;
        let excess = (speed_mps / permitted_mps).max(1.0);
        Some(((permitted_mps - speed_mps) / step_s).max(-self.comfortable_braking_mps2() * excess * excess))
    }

    /// Arc lengths that it would reach at `t = 1…N` at its present speed \[m\]; empty on a straight road, where they are not needed.
    pub(crate) fn expected_along_m(&self, horizon: usize, step_s: f64) -> Vec<f64> {
        if self.route.straight().is_some() {
            return Vec::new();
        }
        let here_m = self.along_m();
        (1..=horizon).map(|t| here_m + self.state.speed_mps * step_s * t as f64).collect()
    }

    /// With what it brakes for a speed limit or a line \[m/s²\].
    pub(super) fn comfortable_braking_mps2(&self) -> f64 {
        let strongest_mps2 = COMFORTABLE_BRAKING_SHARE * self.limits.acceleration_min_mps2.abs();
        let borne_mps2 = self.limits.comfort.map(|comfort| BORNE_BRAKING_SHARE * comfort.braking_mps2);
        borne_mps2.map_or(strongest_mps2, |borne_mps2| borne_mps2.min(strongest_mps2))
    }

    /// The speeds at `t = 1…N` of a comfortable approach to a line at which its front stops, from its present speed on; while it
    /// does not have to brake for the line, the speed that it wants \[m/s\].
    pub(crate) fn approach_speeds_mps(&self, line_m: f64, wanted_mps: f64, horizon: usize, step_s: f64) -> Vec<f64> {
        let Limits { acceleration_min_mps2, acceleration_max_mps2, .. } = self.limits;
        let braking_mps2 = self.comfortable_braking_mps2();
        let mut speed_mps = self.state.speed_mps;
        let mut room_m = line_m - self.body.front_m - self.along_m();
        let speeds = (0..horizon).map(|_| {
            let permitted_mps = (2.0 * braking_mps2 * room_m.max(0.0)).sqrt().min(wanted_mps);
            let (low, high) =
                (acceleration_min_mps2 * step_s, COMFORTABLE_ACCELERATION_SHARE * acceleration_max_mps2 * step_s);
            speed_mps = (speed_mps + (permitted_mps - speed_mps).clamp(low, high)).max(0.0);
            room_m -= step_s * speed_mps;
            if permitted_mps < wanted_mps { speed_mps } else { wanted_mps }
        });
        speeds.collect()
    }
}

impl Agent {
    /// Highest permitted speeds at the stages of a plan, lowered to a comfortable approach to the line at which it has to wait; as they
    /// are without one \[m/s\].
    pub(crate) fn up_to_its_line(
        &self,
        permitted_mps: Vec<f64>,
        wanted_mps: f64,
        horizon: usize,
        step_s: f64,
    ) -> Vec<f64> {
        let permitted_mps = self.up_to_its_gap(permitted_mps, horizon, step_s);
        let permitted_mps = self.letting_in(permitted_mps, wanted_mps, step_s);
        let Some(line_m) = self.rules.stop_line_m else { return permitted_mps };
        let approach_mps = self.approach_speeds_mps(line_m, wanted_mps, horizon, step_s);
        let permitted_mps = permitted_mps.into_iter().chain(std::iter::repeat(f64::INFINITY));
        permitted_mps.zip(approach_mps).map(|(limit_mps, speed_mps)| speed_mps.min(limit_mps)).collect()
    }

    /// The same, lowered a little where it lets another vehicle in.
    fn letting_in(&self, mut permitted_mps: Vec<f64>, wanted_mps: f64, step_s: f64) -> Vec<f64> {
        if self.rules.lets_in {
            let most_mps = wanted_mps - COURTESY_MPS * self.body.real_ratio().sqrt();
            self.slow_down_to(most_mps, COURTESY_MPS2 * step_s, &mut permitted_mps);
        }
        permitted_mps
    }

    /// The same, lowered until there is room to merge to the speed with which it comes there then, in comfort.
    fn up_to_its_gap(&self, mut permitted_mps: Vec<f64>, horizon: usize, step_s: f64) -> Vec<f64> {
        let (Some(most_mps), Some(merging)) = (self.merging_speed_mps(), &self.rules.merging) else {
            return permitted_mps;
        };
        permitted_mps.resize(horizon, f64::INFINITY);
        let stages = horizon.min((merging.in_s / step_s) as usize + 1);
        self.slow_down_to(most_mps, self.comfortable_braking_mps2() * step_s, &mut permitted_mps[..stages]);
        permitted_mps
    }

    /// Lowers the permitted speeds of the first stages to a speed \[m/s\], as fast as it becomes slower in each stage \[m/s\].
    fn slow_down_to(&self, most_mps: f64, slower_mps: f64, permitted_mps: &mut [f64]) {
        for (stage, permitted_mps) in permitted_mps.iter_mut().enumerate() {
            let reached_mps = self.state.speed_mps - slower_mps * (stage + 1) as f64;
            *permitted_mps = permitted_mps.min(most_mps.max(reached_mps));
        }
    }
}

impl Scene {
    /// The speeds at `t = 1…N` that the planning vehicle must not exceed, empty for one that keeps no rules \[m/s\].
    ///
    /// They are the least of: what limits and curves permit where it is expected to be, what it wants (no driver may race to be ahead
    /// of another), and a comfortable approach to the line at which it has to wait. From a speed above the first two they fall with
    /// comfortable braking. They stay a little above zero, so that a plan has room within its bounds.
    pub(crate) fn speed_caps_mps(&self) -> Vec<f64> {
        let ego = &self.ego;
        if !ego.rules.are_kept {
            return Vec::new();
        }
        let near_m = ego.expected_along_m(self.horizon, self.step_s);
        let permitted_mps = ego.permitted_speeds_mps(&near_m);
        let creeping_mps = CREEPING_MPS * ego.body.scale.sqrt();
        let (wanted_mps, braking_mps2) = (self.goal.target.speed_mps, ego.comfortable_braking_mps2());
        // Where accelerations change evenly over a step, one that goes on adds this much.
        let rolls_on_mps = ego
            .limits
            .comfort
            .map_or(0.0, |_| ROLLING_ON_SHARE * ego.previous_input.acceleration_mps2.max(0.0) * self.step_s);
        let caps_mps = (0..self.horizon).map(|stage| {
            let permitted_mps =
                permitted_mps.get(stage).copied().unwrap_or(f64::INFINITY).min(wanted_mps) - rolls_on_mps;
            permitted_mps.max(ego.state.speed_mps - braking_mps2 * self.step_s * (stage + 1) as f64)
        });
        let caps_mps = ego.up_to_its_line(caps_mps.collect(), wanted_mps, self.horizon, self.step_s);
        caps_mps.into_iter().map(|cap_mps| cap_mps.max(creeping_mps)).collect()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use crate::road::centre_line::Piece;
    use crate::{CentreLine, Profile, Route, fixture};

    /// A plan that reaches beyond the last curve of a road without speed limits keeps the speeds of the curve.
    #[test]
    fn a_curve_limits_the_speed_although_nothing_does_behind_it() {
        let pieces = [
            Piece::Straight { length_m: 10.0 },
            Piece::Arc { length_m: 5.0, curvature_1pm: 0.25 },
            Piece::Straight { length_m: 30.0 },
        ];
        let pieces = crate::road::centre_line::smooth(&pieces, 1.0).expect("room for transitions");
        let line = CentreLine::from_pieces([0.0, 0.0], 0.0, &pieces).expect("a line");
        let edge = Profile::constant;
        let mut agent = fixture::agent(0.0, 0.0, 0.0, 5.0);
        agent.route = Arc::new(Route::curved(line, edge(-1.0), edge(1.0), edge(1.0)));
        agent.limits.lateral_acceleration_max_mps2 = Some(2.0);
        let speeds = agent.permitted_speeds_mps(&[12.0, 14.0, 40.0]);
        // Half of 2 m/s² at a radius of 4 m.
        assert!(speeds[..2].iter().all(|speed| (speed - 2.0).abs() < 0.2), "{speeds:?}");
        assert_eq!(speeds[2], f64::INFINITY);
        assert!(agent.permitted_speeds_mps(&[40.0, 41.0]).is_empty());
    }
}
