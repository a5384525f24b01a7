//! The flows of which vehicles of a scenario come.

use crate::format::flow::{FlowConfig, Headways};

/// The flows of a loaded scenario, whose vehicles are already among the others. They do not distinguish scenarios: all are equal.
#[derive(Clone, Debug, Default)]
pub struct ScenarioFlows(pub(crate) Vec<FlowConfig>);

impl PartialEq for ScenarioFlows {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl ScenarioFlows {
    /// The name of the flow to which the vehicle of this name belongs; `None` if it is stated by itself.
    pub fn of(&self, vehicle: &str) -> Option<&str> {
        let (flow, number) = vehicle.rsplit_once('-')?;
        let is_numbered = !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit());
        let found = self.0.iter().find(|known| is_numbered && known.name == flow);
        found.map(|known| known.name.as_str())
    }

    /// Whether the seed decides when, where, how fast or of which sort vehicles come.
    pub(crate) fn depend_on_seed(&self) -> bool {
        self.0.iter().any(|flow| {
            let is_irregular = flow.headways == Headways::Exponential || flow.speed_sd_mps > 0.0;
            is_irregular || flow.from.len() > 1 || flow.to.len() > 1 || flow.mix.len() > 1
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vehicles_are_of_a_flow_by_its_name_and_a_number() {
        let flows = ScenarioFlows(vec![FlowConfig { name: "on-ramp".to_owned(), ..FlowConfig::default() }]);
        assert_eq!(flows.of("on-ramp-12"), Some("on-ramp"));
        assert_eq!(["on-ramp", "on-ramp-", "on-ramp-x", "car-1"].map(|name| flows.of(name)), [None; 4]);
    }

    #[test]
    fn flows_depend_on_the_seed_unless_all_is_stated() {
        let even = FlowConfig { headways: Headways::Even, ..FlowConfig::default() };
        assert!(!ScenarioFlows(vec![even.clone()]).depend_on_seed());
        assert!(ScenarioFlows(vec![FlowConfig { speed_sd_mps: 1.0, ..even }]).depend_on_seed());
        assert!(ScenarioFlows(vec![FlowConfig::default()]).depend_on_seed());
    }
}
