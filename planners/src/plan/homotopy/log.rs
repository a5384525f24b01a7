//! Changes of the homotopy class as events.

use super::homotopy_class;
use crate::plan::planned_passing::PlannedPassing;
use crate::{Plan, PlanEvent, PlanEventKind, Scene};

/// How each vehicle was passed by the last plan that came near it.
#[derive(Clone, Debug, Default)]
pub(crate) struct HomotopyLog {
    known: Vec<PlannedPassing>,
}

impl HomotopyLog {
    /// Writes its homotopy class into a plan, and an event for each vehicle that is passed in a way that is new or has changed.
    pub(crate) fn note(&mut self, scene: &Scene, plan: &mut Plan) {
        plan.homotopy_class = homotopy_class(scene, plan);
        for passing in &plan.homotopy_class {
            match self.known.iter_mut().find(|known| known.of == passing.of) {
                Some(known) if known == passing => continue,
                Some(known) => known.side = passing.side,
                None => self.known.push(passing.clone()),
            }
            let kind = PlanEventKind::Passing(passing.clone());
            plan.events.push(PlanEvent { kind, text: passing.sentence() });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{agent, scene};
    use crate::prediction::constant_velocity;

    /// A side is an event when it is new and when it changes, and not in between.
    #[test]
    fn a_change_is_told_once() {
        let mut log = HomotopyLog::default();
        let mut told = |other_x_m: f64| {
            let other = crate::Agent { name: "front".to_owned(), ..agent(other_x_m, 0.0, 0.0, 1.0) };
            let scene = scene(agent(0.0, 0.0, 0.0, 1.0), vec![other]);
            let trajectory = constant_velocity(&scene.ego.state, scene.horizon, scene.step_s);
            let mut plan = Plan { trajectory, ..Plan::default() };
            log.note(&scene, &mut plan);
            plan.events.into_iter().map(|event| event.text).collect::<Vec<_>>()
        };
        assert_eq!(told(1.0), ["stays behind front"]);
        assert!(told(1.1).is_empty(), "no change");
        assert!(told(9.0).is_empty(), "not relevant");
        assert!(told(1.0).is_empty(), "as it was last");
        assert_eq!(told(-1.0), ["goes ahead of front"]);
    }
}
