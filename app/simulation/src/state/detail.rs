//! Level of detail: humans who are far from the ego follow the intelligent driver model, and are humans again when they come near.

use interplay_planners::drivers::idm;
use interplay_planners::{Driver, Planner, State};
use interplay_scenarios::Scenario;

use crate::state::not_copied::NotCopied;

/// Who is near stays near up to this many times the distance within which everybody is, so that nobody changes to and fro.
const STAYS_NEAR: f64 = 1.1;

/// The two drivers of a vehicle that is simulated closely near the ego only.
#[derive(Debug)]
pub struct LevelOfDetail {
    /// Index of the ego.
    ego: usize,
    /// So near to the ego it drives as its scenario says \[m\].
    within_m: f64,
    /// Who drives near the ego, and has not planned yet.
    near: Planner,
    /// Who drives far from it, and has not planned yet.
    far: Planner,
    /// Whether it is far.
    is_far: bool,
}

impl LevelOfDetail {
    /// That of a vehicle of a scenario; none for whoever drives in the same way everywhere.
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

    /// The driver who takes over, if the vehicle has come near or is near no more, and that in words. `states` are those of everybody
    /// who is there.
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

    /// A copy that remembers the same, for the vehicle called `name`.
    ///
    /// # Errors
    /// [`NotCopied`] if one of its drivers does not fork.
    pub fn fork(&self, name: &str) -> Result<Self, NotCopied> {
        let copy = |planner: &Planner| planner.fork().ok_or_else(|| NotCopied::driver_of(name));
        Ok(LevelOfDetail { near: copy(&self.near)?, far: copy(&self.far)?, ..*self })
    }
}

fn distance_m(a: &State, b: &State) -> f64 {
    libm::hypot(a.x_m - b.x_m, a.y_m - b.y_m)
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::{Scenario, from_text};

    use crate::Simulation;

    /// The ego comes up behind three slower people on another lane, 100 to 300 m ahead.
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

    /// For each vehicle the time at which it first plans with a problem, which the intelligent driver model never does.
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
    fn people_far_from_the_ego_follow_a_model_until_it_comes_near() {
        let (from_s, digest) = human_from_s(&street("detail = { within_m = 60.0 }"));
        let [Some(ego_s), Some(a_s), Some(b_s), None] = from_s[..] else { panic!("{from_s:?}") };
        assert_eq!(ego_s, 0.0);
        assert!(1.0 < a_s && a_s + 3.0 < b_s, "{from_s:?}");
        assert_ne!(digest, human_from_s(&street("")).1);
    }

    #[test]
    fn a_level_of_detail_that_reaches_everybody_changes_nothing() {
        assert_eq!(human_from_s(&street("detail = { within_m = 1000.0 }")), human_from_s(&street("")));
    }

    /// A run goes on from a snapshot with whoever has the wheel then.
    #[test]
    fn a_snapshot_knows_who_has_the_wheel() {
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
