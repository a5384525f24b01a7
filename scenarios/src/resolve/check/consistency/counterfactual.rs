//! The check of counterfactuals, apart from the scenarios that they run.

use interplay_common::spelling::suggestion;

use super::checker::Checker;
use crate::format::read::tree::TomlNode;
use crate::model::expectations::counterfactual::CounterfactualConfig;
use crate::model::expectations::expect::{CounterfactualExpect, Expect};
use crate::model::scenario::Scenario;
use crate::text::error::{Fault, quoted};

/// The faults of the counterfactuals of a scenario, apart from those of their changes. `as_written` are the scenarios that
/// are run for them without the flags; flags may have removed what the counterfactuals refer to.
pub(crate) fn check(
    scenario: &Scenario,
    all: &[CounterfactualConfig],
    tree: &TomlNode,
    as_written: Option<&[&Scenario]>,
) -> Vec<Fault> {
    let mut checker = Checker::new(scenario, tree);
    for (index, counterfactual) in all.iter().enumerate() {
        checker.counterfactual_name(index, all);
        checker.purpose(index, counterfactual, as_written.and_then(|runs| runs.get(index).copied()));
        checker.shifts(index, counterfactual);
        if as_written.is_some() {
            checker.breaks(index, counterfactual);
        }
    }
    checker.faults
}

impl Checker<'_> {
    fn counterfactual_name(&mut self, index: usize, all: &[CounterfactualConfig]) {
        let name = &all[index].name;
        if let Some(first) = all[..index].iter().position(|other| other.name == *name) {
            let message = format!("two counterfactuals are called {}", quoted(name));
            let fault = Fault::at(self.place(&format!("counterfactual.{index}.name")), "the second", message);
            let fault = fault.also(self.place(&format!("counterfactual.{first}.name")), "the first");
            self.faults.push(fault.help("give each counterfactual a name of its own"));
        }
    }

    /// Whether it changes something, and has an expectation.
    fn purpose(&mut self, index: usize, counterfactual: &CounterfactualConfig, run: Option<&Scenario>) {
        let (path, name) = (format!("counterfactual.{index}"), quoted(&counterfactual.name));
        if counterfactual.planner.is_none() && counterfactual.set.is_empty() {
            let help =
                "state `planner = \"conservative\"`, or `set = { \"vehicle.ego.goal.speed_mps\" = 1.2 }`, for example";
            self.refuse(&path, "no change", format!("the counterfactual {name} changes nothing"), help);
        } else if run.is_some_and(|run| is_same_run(run, self.scenario)) {
            let help = "the scenario has these values already";
            self.refuse(&path, "no change", format!("the counterfactual {name} changes nothing"), help);
        }
        if counterfactual.expect == CounterfactualExpect::default() {
            let help = "state in `[counterfactual.expect]` what of `[expect]`, `order_differs`, `later`, `earlier` or `breaks`";
            self.refuse(&path, "nothing expected", format!("the counterfactual {name} expects nothing"), help);
        }
        if self.scenario.vehicles.is_empty() && counterfactual.expect.order_differs.is_some() {
            let message = "`order_differs` is stated, but there are no vehicles".to_owned();
            self.refuse(&format!("{path}.expect.order_differs"), "for vehicles only", message, "");
        }
    }

    /// Whether the vehicles of `later` and `earlier` exist.
    fn shifts(&mut self, index: usize, counterfactual: &CounterfactualConfig) {
        let expect = &counterfactual.expect;
        for (key, shifts) in [("later", &expect.later), ("earlier", &expect.earlier)] {
            for (entry, shift) in shifts.iter().enumerate() {
                if self.scenario.vehicle(&shift.vehicle).is_none() {
                    let names: Vec<&str> = self.scenario.vehicles.iter().map(|vehicle| vehicle.name.as_str()).collect();
                    let path = format!("counterfactual.{index}.expect.{key}.{entry}.vehicle");
                    let message = format!("there is no vehicle {}", quoted(&shift.vehicle));
                    let help = suggestion(&shift.vehicle, "the vehicles are", &names);
                    self.refuse(&path, "unknown vehicle", message, &help);
                }
            }
        }
    }

    /// Whether the scenario states the expectations that are to fail.
    fn breaks(&mut self, index: usize, counterfactual: &CounterfactualConfig) {
        let names = self.scenario.expect.names();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        for (entry, name) in counterfactual.expect.breaks.iter().flatten().enumerate() {
            if !names.contains(&name.as_str()) {
                let path = format!("counterfactual.{index}.expect.breaks.{entry}");
                let message = format!("the scenario's own `[expect]` has no {}", quoted(name));
                self.refuse(&path, "not expected", message, &suggestion(name, "it has", &names));
            }
        }
    }
}

/// Whether both scenarios, neither with counterfactuals, have the same run, whatever their expectations.
fn is_same_run(one: &Scenario, other: &Scenario) -> bool {
    let run = |scenario: &Scenario| Scenario { figure: None, expect: Expect::default(), ..scenario.clone() };
    run(one) == run(other)
}
