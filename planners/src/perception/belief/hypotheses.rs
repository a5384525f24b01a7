//! The plans of the drivers that an observed one may be.
//!
//! For each wish there are three humans, who differ by their safety weight. A tough plan that enters no ellipse is also the
//! plan of the others: it costs them the same, and no motion costs them less than it costs the tough one. Only where the plans
//! may differ are they computed.

use super::wishes::Wish;
use crate::drivers::drive::Drive;
use crate::drivers::human::{self, Human};
use crate::scene::driver_estimate::SAFETY_WEIGHTS;
use crate::scene::inferred_futures::InferredFutures;
use crate::{Goal, PlanError, Scene, Trajectory};

/// Ellipses count as free below this difference of the costs, relative to `1 + cost`.
const FREE_COST_RATIO: f64 = 1e-9;

/// Root mean square distance below which two plans of 1/10 scale cars nearly coincide \[m\].
const COINCIDENCE_M: f64 = 0.02;

/// Most work of one descent to a supposed plan: a longer one goes to and fro, and what it has come to is a plan. With 200, twins of another
/// size drift apart, since what is left undone depends on rounding.
const PLAN_WORK: usize = 500;

/// Places of styles in the list of weights.
const NORMAL: usize = 1;
const NICE: usize = 2;

/// The humans with one wish.
#[derive(Clone, Debug)]
pub(super) struct WishfulHumans {
    pub wish: Wish,
    tough: Human,
    /// Those with a plan of their own, by style; the tough one stands apart.
    split: [Option<Human>; 2],
    /// The plan of each style as of the last sighting; none where it was not computed.
    pub plans: [Option<Trajectory>; 3],
}

impl WishfulHumans {
    pub(super) fn new(wish: Wish) -> WishfulHumans {
        let settings = human::Settings { safety_weight: Some(SAFETY_WEIGHTS[0]), ..human::Settings::default() };
        let tough = Human::new(settings).limited_to(PLAN_WORK);
        WishfulHumans { wish, tough, split: [None, None], plans: [None, None, None] }
    }

    /// Forgets all plans of the last sighting.
    pub(super) fn forget_plans(&mut self) {
        self.plans = [None, None, None];
    }

    /// Plans for each style; returns how many problems were posed. `scene` is seen by the driver; its goal is replaced.
    pub(super) fn plan(&mut self, scene: &mut Scene) -> usize {
        scene.goal = self.wish.goal;
        let Ok(tough) = self.tough.plan(scene, &InferredFutures::default()) else {
            self.split = [None, None];
            return 1;
        };
        let tough = tough.trajectory;
        if is_free(scene, &tough) {
            self.split = [None, None];
            self.plans = [0; 3].map(|_| Some(tough.clone()));
            return 1;
        }
        self.plans[0] = Some(tough);
        let mut problems = 1;
        for style in [NICE, NORMAL] {
            if style == NORMAL && self.is_between_equals(scene.ego.body.scale) {
                (self.split[style - 1], self.plans[style]) = (None, self.plans[NICE].clone());
            } else {
                let human =
                    self.split[style - 1].get_or_insert_with(|| self.tough.with_safety_weight(SAFETY_WEIGHTS[style]));
                self.plans[style] = human.plan(scene, &InferredFutures::default()).ok().map(|plan| plan.trajectory);
                problems += 1;
            }
        }
        problems
    }

    /// Whether tough and nice nearly coincide, and so what lies between them.
    fn is_between_equals(&self, scale: f64) -> bool {
        let [Some(tough), _, Some(nice)] = &self.plans else { return false };
        let steps = tough.states.len().max(1) as f64;
        tough.squared_distance(nice) <= steps * (COINCIDENCE_M * scale) * (COINCIDENCE_M * scale)
    }

    /// The human of a style as it is after its last plan.
    pub(super) fn driver(&self, style: usize) -> Human {
        let own = style.checked_sub(1).and_then(|split| self.split[split].clone());
        own.unwrap_or_else(|| self.tough.with_safety_weight(SAFETY_WEIGHTS[style]))
    }

    /// The goal that they share.
    pub(super) fn goal(&self) -> Goal {
        self.wish.goal
    }
}

/// Whether a plan of the tough human costs the nice one the same.
fn is_free(scene: &Scene, plan: &Trajectory) -> bool {
    let cost = |weight: f64| {
        let settings = human::Settings { safety_weight: Some(weight), ..human::Settings::default() };
        human::problem(scene, &settings).cost_of(std::slice::from_ref(&plan.inputs))
    };
    let [tough, _, nice] = SAFETY_WEIGHTS.map(cost);
    nice - tough <= FREE_COST_RATIO * (1.0 + tough.abs())
}

/// A hypothesised driver that goes on from its last plan while the delay is made up for.
pub(super) enum Continuing {
    Human(Box<Human>, Goal),
    Idm(Box<crate::drivers::idm::Idm>, Goal),
    Unknown,
}

impl Continuing {
    /// Its plan in a scene that it sees.
    pub(super) fn plan(&mut self, scene: &mut Scene) -> Result<Option<Trajectory>, PlanError> {
        let plan = match self {
            Continuing::Human(human, goal) => {
                scene.goal = *goal;
                human.plan(scene, &InferredFutures::default())?
            }
            Continuing::Idm(idm, goal) => {
                scene.goal = *goal;
                idm.plan(scene, &InferredFutures::default())?
            }
            Continuing::Unknown => return Ok(None),
        };
        Ok(Some(plan.trajectory))
    }
}
