//! Level of detail: human drivers far from the ego are replaced by the intelligent driver model until they come near.

use interplay_planners::drivers::idm;
use interplay_planners::{Driver, Planner, State};
use interplay_scenarios::Scenario;
use thiserror::Error;

/// A near vehicle stays near up to this multiple of the distance, so that drivers do not alternate.
const STAYS_NEAR: f64 = 1.1;

/// The two drivers of a vehicle that is simulated in detail only near the ego.
#[derive(Debug)]
pub struct LevelOfDetail {
    ego: usize,
    /// Distance to the ego within which it drives as its scenario states \[m\].
    within_m: f64,
    /// The driver near the ego, before its first plan.
    near: Planner,
    /// The driver far from the ego, before its first plan.
    far: Planner,
    is_far: bool,
}

impl LevelOfDetail {
    /// The two drivers of a vehicle of a scenario; `None` for a vehicle that always has the same driver.
    pub fn of(scenario: &Scenario, index: usize) -> Option<Self> {
        let (detail, vehicle) = (scenario.detail_of(index)?, &scenario.vehicles[index]);
        let far = Driver::Idm(idm::Settings::literature().scaled(vehicle.body.real_ratio()));
        Some(LevelOfDetail {
            ego: scenario.ego_index(),
            within_m: detail.within_m,
            near: vehicle.planner(),
            far: far.planner(),
            is_far: false,
        })
    }

    /// The driver that takes over, with a description, if the vehicle has come near the ego or left its surroundings.
    /// `states` are those of all vehicles on the road.
    pub fn successor(&mut self, index: usize, states: &[Option<State>]) -> Option<(Planner, String)> {
        let own = states[index]?;
        let from_ego_m = states[self.ego].map_or(f64::INFINITY, |ego| distance_m(&own, &ego));
        let is_far = from_ego_m > if self.is_far { self.within_m } else { STAYS_NEAR * self.within_m };
        if is_far == self.is_far {
            return None;
        }
        self.is_far = is_far;
        let (successor, text) = if is_far {
            (&self.far, "is far from the ego, and follows the intelligent driver model")
        } else {
            (&self.near, "is near the ego, and drives as `human`")
        };
        Some((successor.fork()?, text.to_owned()))
    }

    /// A copy with the same memory, for the vehicle called `name`.
    ///
    /// # Errors
    /// [`NotCopied`] if one of its drivers cannot be copied.
    pub fn fork(&self, name: &str) -> Result<Self, NotCopied> {
        let copy = |planner: &Planner| planner.fork().ok_or_else(|| NotCopied::driver_of(name));
        Ok(LevelOfDetail { near: copy(&self.near)?, far: copy(&self.far)?, ..*self })
    }
}

fn distance_m(a: &State, b: &State) -> f64 {
    libm::hypot(a.x_m - b.x_m, a.y_m - b.y_m)
}

/// Why a running world cannot be copied.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{who} cannot be copied: {why}")]
pub struct NotCopied {
    /// The part of the world.
    pub who: String,
    /// Why the piece of state has no copy.
    pub why: String,
}

impl NotCopied {
    /// The error that the entity of the vehicle called `name` was removed from the world, or lacks one of its initial components.
    pub fn incomplete(name: &str) -> Self {
        NotCopied { who: format!("the vehicle `{name}`"), why: "an added system removed it or a part of it".to_owned() }
    }

    /// The error that the driver of the vehicle called `name` cannot be copied.
    pub fn driver_of(name: &str) -> Self {
        NotCopied { who: format!("the driver of `{name}`"), why: "it does not implement `fork`".to_owned() }
    }
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::{Scenario, from_text};

    use crate::Simulation;

    /// The ego approaches three slower human drivers in another lane, 100 to 300 m ahead.
    fn street(detail: &str) -> Scenario {
        let car = |name: &str, lane: u8, along_m: f64, speed_mps: f64| {
            let start = format!("{{ along_m = {along_m}, lane = {lane}, speed_mps = {speed_mps} }}");
            format!("[[vehicle]]\nname = '{name}'\nstart = {start}\ndriver = {{ kind = 'human' }}\n")
        };
        let cars =
            [car("ego", 0, 0.0, 25.0), car("a", 1, 100.0, 10.0), car("b", 1, 200.0, 10.0), car("c", 1, 300.0, 10.0)];
        let text = format!(
            "title = 't'\nshows = 's'\nduration_s = 12.0\n{detail}\n[road]\nkind = 'lanes'\nlane_width_m = 3.5\n[defaults]\nclass = 'car'\n{}",
            cars.concat()
        );
        from_text("street.toml", &text, &[]).expect("a scenario")
    }

    /// For each vehicle the time of its first plan with an optimisation problem, which the intelligent driver model does not have.
    fn human_from_s(scenario: &Scenario) -> (Vec<Option<f64>>, String) {
        let mut simulation = Simulation::new(scenario).expect("a world");
        let mut from_s = vec![None; scenario.vehicles.len()];
        while let Some(frame) = simulation.step().expect("a step") {
            for (from_s, vehicle) in from_s.iter_mut().zip(&frame.vehicles) {
                if vehicle.plan.problem.is_some() {
                    from_s.get_or_insert(frame.time_s);
                }
            }
        }
        (from_s, simulation.finish().expect("a run").digest)
    }

    #[test]
    fn human_drivers_far_from_the_ego_follow_idm_until_it_comes_near() {
        let (from_s, digest) = human_from_s(&street("detail = { within_m = 60.0 }"));
        let [Some(ego_s), Some(a_s), Some(b_s), None] = from_s[..] else { panic!("{from_s:?}") };
        assert_eq!(ego_s, 0.0);
        assert!(1.0 < a_s && a_s + 3.0 < b_s, "{from_s:?}");
        assert_ne!(digest, human_from_s(&street("")).1);
    }

    #[test]
    fn a_level_of_detail_that_includes_all_vehicles_changes_nothing() {
        assert_eq!(human_from_s(&street("detail = { within_m = 1000.0 }")), human_from_s(&street("")));
    }

    /// A resumed run continues with the driver in control at the snapshot.
    #[test]
    fn a_snapshot_keeps_the_driver_in_control() {
        let mut simulation = Simulation::new(&street("detail = { within_m = 60.0 }")).expect("a world");
        for _ in 0..40 {
            simulation.step().expect("a step");
        }
        let mut copy = simulation.snapshot().expect("a copy").resume().expect("a world");
        while copy.step().expect("a step").is_some() {}
        while simulation.step().expect("a step").is_some() {}
        assert_eq!(copy.finish().expect("a run").digest, simulation.finish().expect("a run").digest);
    }
}
