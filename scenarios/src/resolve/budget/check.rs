//! The check of a scenario's cost against its limits.

use super::RunCost;
use crate::format::read::tree::TomlNode;
use crate::model::scenario::Scenario;
use crate::model::traffic::plant::Plant;
use crate::text::error::Fault;

/// With more steps a day, these make a design large, and not the zones: those of half an hour.
const USUAL_STEPS_PER_DAY: usize = 48;

/// The limits that one run would exceed, blamed on the keys that make it large.
pub(crate) fn check(scenario: &Scenario, tree: &TomlNode) -> Vec<Fault> {
    let cost = RunCost::estimate(scenario);
    exceeded(scenario, &cost).into_iter().map(|excess| excess.fault(scenario, tree)).collect()
}

/// The limits that the run and its counterfactuals together would exceed, where none does by itself.
pub(crate) fn check_all(scenario: &Scenario, tree: &TomlNode) -> Vec<Fault> {
    let fault = |excess: Excess| {
        let message =
            format!("with its {} counterfactuals the scenario makes {excess}", scenario.counterfactuals.len());
        Fault::at(tree.place_of("counterfactual"), "too much together", message)
            .help(format!("state fewer counterfactuals, or allow it: {}", excess.allowance()))
    };
    exceeded(scenario, &scenario.cost()).into_iter().map(fault).collect()
}

/// A limit, and the estimate that is compared with it.
struct Excess {
    quantity: Quantity,
    found: u64,
    limit: u64,
}

#[derive(Clone, Copy)]
enum Quantity {
    Plans,
    Steps,
    Design,
    Time,
    Recording,
}

fn exceeded(scenario: &Scenario, cost: &RunCost) -> Vec<Excess> {
    let limits = scenario.budget;
    let all = [
        (Quantity::Plans, cost.plans, limits.plans),
        (Quantity::Steps, cost.steps, limits.steps),
        (Quantity::Design, cost.design_gop.ceil() as u64, limits.design_gop),
        (Quantity::Time, cost.processor_s.ceil() as u64, limits.processor_s),
        (Quantity::Recording, cost.recorded_mb.ceil() as u64, limits.recorded_mb),
    ];
    let over = all.into_iter().filter(|(_, found, limit)| found > limit);
    over.map(|(quantity, found, limit)| Excess { quantity, found, limit }).collect()
}

impl std::fmt::Display for Excess {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Excess { quantity, found, limit } = self;
        match quantity {
            Quantity::Plans => write!(f, "{found} plans, more than {limit}"),
            Quantity::Steps => write!(f, "{found} steps, more than {limit}"),
            Quantity::Design => {
                write!(f, "days that take about {found} billion operations to design, more than {limit}")
            }
            Quantity::Time => write!(f, "work of about {found} s for a processor, more than {limit} s"),
            Quantity::Recording => write!(f, "a recording of about {found} MB, more than {limit} MB"),
        }
    }
}

impl Excess {
    /// The line that raises the limit far enough.
    fn allowance(&self) -> String {
        let key = match self.quantity {
            Quantity::Plans => "plans",
            Quantity::Steps => "steps",
            Quantity::Design => "design_gop",
            Quantity::Time => "processor_s",
            Quantity::Recording => "recorded_mb",
        };
        format!("`budget = {{ {key} = {} }}`", self.found)
    }

    fn fault(&self, scenario: &Scenario, tree: &TomlNode) -> Fault {
        let (key, remedy) = self.cause(scenario);
        let message = format!("the run makes {self}");
        let help = format!("{remedy}, or allow it: {}", self.allowance());
        Fault::at(tree.place_of(key), "makes it large", message).help(help)
    }

    /// The key that makes it large, and how to make it smaller.
    fn cause(&self, scenario: &Scenario) -> (&'static str, String) {
        let share = self.limit as f64 / self.found as f64;
        let shorter = |help: &str| {
            let duration_s = (scenario.duration_s * share).floor();
            let fewer = if scenario.vehicles.len() > 1 { " or state fewer vehicles" } else { "" };
            ("duration_s", format!("lower `duration_s` to {duration_s}, {help}{fewer}"))
        };
        let fewer_days =
            || ("iterations", "lower `iterations`, lengthen `building.step_s` or state fewer zones".to_owned());
        match self.quantity {
            Quantity::Plans => shorter("lengthen `step_s`"),
            Quantity::Steps if building_steps(scenario) > self.limit => fewer_days(),
            Quantity::Steps if is_dynamic(scenario) && scenario.step_s > 1.0 => {
                let remedy = "lower `step_s` and `duration_s`: the dynamic plant cuts each second into 1000 sub-steps";
                ("step_s", remedy.to_owned())
            }
            Quantity::Steps if is_dynamic(scenario) => shorter("drive with the kinematic plant"),
            Quantity::Steps => shorter("lengthen `step_s`"),
            Quantity::Design => {
                let short =
                    scenario.building.as_ref().is_some_and(|building| building.steps_per_day() > USUAL_STEPS_PER_DAY);
                let remedy = "lengthen `building.step_s`, state fewer zones, or take another `controller.kind`";
                (if short { "building.step_s" } else { "building" }, remedy.to_owned())
            }
            Quantity::Time if building_steps(scenario) > 0 && scenario.vehicles.is_empty() => fewer_days(),
            Quantity::Time => shorter(
                "lower `horizon_steps`, take a planner that is quicker (`interplay check --planner` says), do without `passing_orders = \"global\"`",
            ),
            Quantity::Recording if building_steps(scenario) as f64 > scenario.tick_count() as f64 => fewer_days(),
            Quantity::Recording => shorter("lower `horizon_steps`"),
        }
    }
}

/// Steps of all zones of the building.
fn building_steps(scenario: &Scenario) -> u64 {
    let building = scenario.building.as_ref();
    building.map_or(0, |building| (building.steps_per_day() * building.zone_count() * scenario.days()) as u64)
}

fn is_dynamic(scenario: &Scenario) -> bool {
    matches!(scenario.plant, Plant::Dynamic(_))
}
