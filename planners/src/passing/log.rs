//! Changes of passing orders as events.

use super::passing_orders;
use crate::passing_order::PassingOrder;
use crate::{Plan, PlanEvent, PlanEventKind, Scene};

/// The last order with respect to each vehicle that had one so far.
#[derive(Clone, Debug, Default)]
pub(crate) struct PassingOrderLog {
    known: Vec<PassingOrder>,
}

impl PassingOrderLog {
    /// Writes its orders into a plan, and an event for each that is new or has changed.
    pub(crate) fn note(&mut self, scene: &Scene, plan: &mut Plan) {
        plan.passing_orders = passing_orders(scene, plan);
        for order in &plan.passing_orders {
            match self.known.iter_mut().find(|known| known.of == order.of) {
                Some(known) if known == order => continue,
                Some(known) => known.position = order.position,
                None => self.known.push(order.clone()),
            }
            let kind = PlanEventKind::PassingOrder(order.clone());
            plan.events.push(PlanEvent { kind, text: order.sentence() });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{agent, scene};
    use crate::predict::constant_velocity;

    /// An order is an event when it is new and when it changes, and not in between.
    #[test]
    fn a_change_is_told_once() {
        let mut log = PassingOrderLog::default();
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
