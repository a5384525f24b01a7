//! What the ego believes about the other, and the other about the ego.
//!
//! - The variance `Σ` of the signal: the less consistent the ego's plans, the less the other can read from them (eq. 7.27).
//! - The weight `w_1` that the other puts on its own plan: the more its plan changes, the readier it is to change it
//!   (eq. 7.28). Where plans are inferred, a change may be one of the ego's mind about the driver, and errors of what it
//!   senses; there `w_1` is its mean over the kinds of driver that the other may be, from `w_min` of a nice one to `w_max` of
//!   a tough one.
//!
//! Weights over time are uniform. The source gives neither scale: `Σ = min(c α, Σ_max)`, and
//! `w_1 = w_min + (w_max − w_min) exp(−β/β_0)`.

use super::Settings;
use crate::scene::driver_estimate::{DriverEstimate, DriverModel};
use crate::{Agent, Body, State, Trajectory};

/// The beliefs behind a signal, updated at every step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PersuasionBelief {
    /// Mean change of the ego's plan from one step to the next, `α` (eq. 7.27): of all components of its states, in the units
    /// of a 1/10 scale car.
    pub alpha: f64,
    /// Mean change of the other's plan from one step to the next, `β` (eq. 7.28) \[m\].
    pub beta_m: f64,
    /// Variance of the signal, `Σ`, the same for every component.
    pub variance: f64,
    /// Weight that the other puts on its own plan, `w_1`.
    pub w_1: f64,
    /// Squared deviation of the other from its prediction in the last step, weighted with `w_1`: `γ` of eq. 7.27.
    pub deviation: f64,
}

impl PersuasionBelief {
    /// The belief before anything was observed: `w_1` at the geometric mean of its bounds, and a signal without
    /// variance.
    pub fn initial(settings: &Settings) -> Self {
        let w_1 = (settings.w_1_min * settings.w_1_max).sqrt();
        PersuasionBelief { alpha: 0.0, beta_m: 0.0, variance: 0.0, w_1, deviation: 0.0 }
    }

    /// Updates the belief by what the other plans now; `before` is what it planned a step ago.
    pub(super) fn observe(
        &mut self,
        other: &Agent,
        before: &Trajectory,
        estimate: Option<&DriverEstimate>,
        settings: &Settings,
    ) {
        let expected = before.shifted();
        self.beta_m = mean_change(&other.prediction, &expected, |a, b| squared(a.position(), b.position()));
        let range = settings.w_1_max - settings.w_1_min;
        self.w_1 = estimate.map_or_else(
            || settings.w_1_min + range * libm::exp(-self.beta_m / settings.beta_0_m),
            |estimate| estimate.mean(|model| loyalty(model, settings)),
        );
        let strayed = expected.states.first().map_or(0.0, |state| squared(state.position(), other.state.position()));
        self.deviation = self.w_1 * strayed / (other.body.scale * other.body.scale);
    }

    /// Updates the belief by what the ego itself plans now; `before` is what it planned a step ago.
    pub(super) fn observe_own_plan(
        &mut self,
        plan: &Trajectory,
        before: &Trajectory,
        body: &Body,
        settings: &Settings,
    ) {
        let (length, speed) = (body.scale, body.time_ratio());
        let normalised = |state: &State| {
            let [x_m, y_m, heading_rad, speed_mps] = state.to_array();
            [x_m / length, y_m / length, heading_rad, speed_mps / speed]
        };
        self.alpha = mean_change(plan, &before.shifted(), |a, b| squared(normalised(a), normalised(b)));
        self.variance = (settings.variance_per_change * self.alpha).min(settings.variance_max);
    }
}

/// The weight that a kind of driver puts on its own plan: a driver that yields to others changes it for them.
fn loyalty(model: DriverModel, settings: &Settings) -> f64 {
    match model {
        DriverModel::Nice => settings.w_1_min,
        DriverModel::Normal => (settings.w_1_min * settings.w_1_max).sqrt(),
        DriverModel::Tough | DriverModel::Idm | DriverModel::Unknown => settings.w_1_max,
    }
}

/// The mean over `t = 0…N−1` of a distance between the states of two trajectories.
fn mean_change(a: &Trajectory, b: &Trajectory, squared: impl Fn(&State, &State) -> f64) -> f64 {
    let steps = a.horizon().min(b.horizon()).max(1);
    let pairs = a.states.iter().zip(&b.states).take(steps);
    pairs.map(|(a, b)| squared(a, b).sqrt()).sum::<f64>() / steps as f64
}

fn squared<const M: usize>(a: [f64; M], b: [f64; M]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;
    use crate::prediction::constant_velocity;

    fn at(x_m: f64, speed_mps: f64) -> Trajectory {
        constant_velocity(&State { x_m, speed_mps, ..State::default() }, 30, 0.1)
    }

    fn agent(x_m: f64, speed_mps: f64) -> Agent {
        fixture::agent(x_m, 0.0, 0.0, speed_mps)
    }

    fn watched(other: &Agent) -> PersuasionBelief {
        let settings = Settings::default();
        let mut belief = PersuasionBelief::initial(&settings);
        belief.observe(other, &at(0.0, 1.0), None, &settings);
        belief
    }

    #[test]
    fn a_driver_is_loyal_to_its_plan_exactly_if_it_keeps_it() {
        let settings = Settings::default();
        let steady = watched(&agent(0.1, 1.0));
        assert!(steady.beta_m < 1e-12 && (steady.w_1 - settings.w_1_max).abs() < 1e-9 && steady.deviation < 1e-20);
        let wavering = [0.99, 0.95, 0.8, 0.5].map(|speed| watched(&agent(0.1, speed)).w_1);
        assert!(wavering.windows(2).all(|pair| pair[0] > pair[1]), "{wavering:?}");
        assert!((wavering[3] - settings.w_1_min).abs() < 1e-6);
        // A change of 0.01 m on average: 1/e of the range.
        let one = watched(&agent(0.11, 1.0));
        assert!((one.beta_m - 0.01).abs() < 1e-12);
        assert!(
            (one.w_1 - (settings.w_1_min + (settings.w_1_max - settings.w_1_min) / std::f64::consts::E)).abs() < 1e-9
        );
    }

    #[test]
    fn where_plans_are_inferred_the_kind_of_driver_says_how_loyal_it_is() {
        let settings = Settings::default();
        let believed = |probabilities: [f64; 5]| {
            let estimate = DriverEstimate::new("other", DriverModel::Nice, probabilities);
            let mut belief = PersuasionBelief::initial(&settings);
            belief.observe(&agent(0.1, 0.5), &at(0.0, 1.0), Some(&estimate), &settings);
            belief.w_1
        };
        assert_eq!(believed([0.0, 0.0, 1.0, 0.0, 0.0]), settings.w_1_min);
        assert_eq!(believed([1.0, 0.0, 0.0, 0.0, 0.0]), settings.w_1_max);
        let half = believed([0.5, 0.0, 0.5, 0.0, 0.0]);
        assert!((half - 0.5 * (settings.w_1_min + settings.w_1_max)).abs() < 1e-12);
    }

    #[test]
    fn a_consistent_plan_is_a_clear_signal() {
        let settings = Settings::default();
        let mut belief = PersuasionBelief::initial(&settings);
        belief.observe_own_plan(&at(0.1, 1.0), &at(0.0, 1.0), &Body::default(), &settings);
        assert!(belief.variance < 1e-12);
        belief.observe_own_plan(&at(0.12, 1.0), &at(0.0, 1.0), &Body::default(), &settings);
        assert!((belief.variance - 0.01).abs() < 1e-12);
        belief.observe_own_plan(&at(1.1, 1.0), &at(0.0, 1.0), &Body::default(), &settings);
        assert_eq!(belief.variance, settings.variance_max);
    }
}
