//! What lets a vehicle begin: another one reaches a place.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::Scene;

/// The moment at which a vehicle reaches a place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Trigger {
    /// Which vehicle; it may be the waiting one itself.
    #[schemars(example = &"ego")]
    pub vehicle: String,
    /// The place that its mass centre reaches, on its way.
    #[schemars(example = json!({ "lane": "street", "along_m": 40.0 }))]
    pub reaches: TriggerPlace,
}

/// A place on the way of a vehicle, which its mass centre reaches.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TriggerPlace {
    /// The lane on its way, on a road whose lanes have names.
    #[serde(default)]
    #[schemars(example = &"street")]
    pub lane: Option<String>,
    /// Distance along the lane, or along the road where lanes have no names \[m\].
    #[schemars(range(min = -100_000.0, max = 100_000.0), example = 40.0)]
    pub along_m: f64,
}

/// Whether a trigger has fired.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct TriggerMemory {
    /// The plan in which it fired, by number.
    fired: Option<usize>,
}

impl TriggerMemory {
    /// Looks at a scene; whether the trigger has fired in it or before.
    pub fn has_fired(&mut self, trigger: &Trigger, scene: &Scene) -> bool {
        self.fired_at(trigger, scene).is_some()
    }

    /// The plan in which it fired, by number; none before.
    pub fn fired(&self) -> Option<usize> {
        self.fired
    }

    /// Looks at a scene; the plan in which the trigger fired, by number.
    fn fired_at(&mut self, trigger: &Trigger, scene: &Scene) -> Option<usize> {
        if self.fired.is_none() && trigger.is_reached(scene) {
            self.fired = Some(scene.tick);
        }
        self.fired
    }
}

impl Trigger {
    /// Whether the vehicle is at the place, or past it.
    fn is_reached(&self, scene: &Scene) -> bool {
        let agents = scene.others.iter().chain([&scene.ego]);
        let Some(agent) = agents.into_iter().find(|agent| agent.name == self.vehicle) else { return false };
        let along_m = match &self.reaches.lane {
            Some(lane) => agent.route.along_m(lane, self.reaches.along_m),
            None => Some(self.reaches.along_m),
        };
        along_m.is_some_and(|along_m| agent.along_m() >= along_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{agent, scene};

    #[test]
    fn it_fires_once_and_for_all() {
        let place = TriggerPlace { lane: None, along_m: 2.0 };
        let trigger = Trigger { vehicle: "ego".to_owned(), reaches: place };
        let mut memory = TriggerMemory::default();
        let mut at = |x_m: f64, tick: usize| {
            let mut ego = agent(x_m, 0.185, 0.0, 1.0);
            ego.name = "ego".to_owned();
            memory.fired_at(&trigger, &Scene { tick, ..scene(ego, Vec::new()) })
        };
        assert_eq!([at(1.0, 1), at(2.5, 2), at(1.0, 3)], [None, Some(2), Some(2)]);
    }
}
