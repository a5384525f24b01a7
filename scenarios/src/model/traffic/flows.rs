//! The flows of which vehicles of a scenario come.

/// The flows of a loaded scenario, whose vehicles are already among the others. They do not distinguish scenarios: all are equal.
#[derive(Clone, Debug, Default)]
pub struct ScenarioFlows {
    pub(crate) names: Vec<String>,
    /// Whether the seed decides when, where, how fast or of which sort vehicles come.
    pub(crate) depend_on_seed: bool,
}

impl PartialEq for ScenarioFlows {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl ScenarioFlows {
    /// The names of all flows, in the order of the file.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.names.iter().map(String::as_str)
    }

    /// The name of the flow to which the vehicle of this name belongs; `None` if it is stated by itself.
    pub fn of(&self, vehicle: &str) -> Option<&str> {
        let (flow, number) = vehicle.rsplit_once('-')?;
        let is_numbered = !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit());
        self.names.iter().find(|known| is_numbered && *known == flow).map(String::as_str)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vehicles_are_of_a_flow_by_its_name_and_a_number() {
        let flows = ScenarioFlows { names: vec!["on-ramp".to_owned()], depend_on_seed: false };
        assert_eq!(flows.of("on-ramp-12"), Some("on-ramp"));
        assert_eq!(["on-ramp", "on-ramp-", "on-ramp-x", "car-1"].map(|name| flows.of(name)), [None; 4]);
    }
}
