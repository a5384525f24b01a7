//! The keys of a plan of many runs, as in its schema.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value as Json, json};

/// A plan of many runs: scenarios, times drivers of the others, times values that vary, times planners of the ego.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PlanFile {
    /// The title of the plan, in a few words.
    #[serde(default)]
    #[schemars(example = &"Planners against styles")]
    pub title: Option<String>,
    /// The scenarios: names of embedded ones, which may have `*` in them, their families, streets such as
    /// `streets/ring/0-19`, files, or folders of files.
    #[schemars(length(min = 1, max = 1000), example = vec!["lane-change/front-nice", "intersection"])]
    pub scenario: Vec<String>,
    /// The planners of the ego: kinds of drivers, or tables with a `name`, a `kind` and changes. Without it, as each file states.
    #[serde(default)]
    #[schemars(length(max = 1000), example = vec!["negotiation", "conservative"])]
    pub planner: Vec<PlannerEntry>,
    /// The drivers of the other vehicles: styles of humans, kinds of drivers, or tables with a `name` and changes. Without it, as
    /// each file states.
    #[serde(default)]
    #[schemars(length(max = 1000), example = vec!["nice", "tough"])]
    pub style: Vec<StyleEntry>,
    /// Whether each scenario's own counterfactuals are also run, as planners of that scenario alone, under their names.
    #[serde(default)]
    pub counterfactuals: bool,
    /// Changes in all runs: paths as in `--set`, each with its new value; `vehicle.*` is every vehicle but the
    /// ego.
    #[serde(default)]
    #[schemars(extend("x-paths" = true))]
    pub set: Map<String, Json>,
    /// The factors: paths, each with a list of values, or with a table `{ range = [from, to], count = n }`,
    /// `{ uniform = [from, to] }`, `{ normal = { mean = m, sd = s } }` or `{ log_uniform = [from, to] }`.
    #[serde(default)]
    #[schemars(extend("x-paths" = true))]
    pub vary: Map<String, Json>,
    /// Random change of every start, drawn from the seed of the sample.
    #[serde(default)]
    #[schemars(example = json!({ "position_m": 0.1, "speed_mps": 0.1 }))]
    pub jitter: Option<PlanJitter>,
    /// How values are chosen: `grid` runs every combination of lists and ranges, each with as many samples of the
    /// distributions; `random` and `latin-hypercube` draw all values for each sample.
    #[serde(default)]
    pub sampling: Sampling,
    /// The number of samples; on a grid, of every combination.
    #[serde(default = "one")]
    #[schemars(range(min = 1))]
    pub samples: u64,
    /// The seed of the first sample; the next samples have the seeds after it. All random values follow from it.
    #[serde(default = "one")]
    pub seed: u64,
    /// The most runs of the plan.
    #[serde(default = "million")]
    #[schemars(range(min = 1))]
    pub max_runs: u64,
}

/// A random change of every start.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct PlanJitter {
    /// Largest change of the position along the road, in both directions \[m\].
    #[schemars(range(min = 0.0))]
    pub position_m: f64,
    /// Largest change of the speed, up and down \[m/s\].
    #[schemars(range(min = 0.0))]
    pub speed_mps: f64,
    /// Whether the amounts are those of cars at 1/10 scale, which are scaled to larger vehicles by Froude's law.
    pub scaled: bool,
}

/// A planner of the ego.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum PlannerEntry {
    /// The kind of driver, which is its name too.
    Kind(String),
    /// One with changes.
    Planner(PlannerArm),
}

/// A planner with a name and changes.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PlannerArm {
    /// Its name, unique in the plan.
    #[schemars(length(min = 1), example = &"patient")]
    pub name: String,
    /// The kind of driver, as in `--planner`; without it, the scenario's own.
    #[serde(default)]
    #[schemars(example = &"negotiation")]
    pub kind: Option<String>,
    /// Further changes.
    #[serde(default)]
    #[schemars(example = json!({ "vehicle.ego.driver.settled_steps": 29 }), extend("x-paths" = true))]
    pub set: Map<String, Json>,
}

/// The drivers of the other vehicles.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum StyleEntry {
    /// A style of humans or a kind of driver, which is its name too.
    Word(String),
    /// One with changes.
    Style(StyleArm),
}

/// Drivers of the other vehicles with a name and changes.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct StyleArm {
    /// Its name, unique in the plan.
    #[schemars(length(min = 1), example = &"continuum")]
    pub name: String,
    /// The changes.
    #[serde(default)]
    #[schemars(example = json!({ "vehicle.*.driver": { "kind": "human" } }), extend("x-paths" = true))]
    pub set: Map<String, Json>,
    /// The factors with these drivers, besides those of all runs.
    #[serde(default)]
    #[schemars(example = json!({ "vehicle.*.driver.safety_weight": { "log_uniform": [0.2, 50.0] } }), extend("x-paths" = true))]
    pub vary: Map<String, Json>,
}

/// How the values of a plan are chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Sampling {
    /// Every combination of lists and ranges; distributions are drawn for each sample.
    #[default]
    Grid,
    /// All values are drawn for each sample.
    Random,
    /// The same, each value once from each of as many equally likely parts as there are samples.
    LatinHypercube,
}

fn one() -> u64 {
    1
}

fn million() -> u64 {
    1_000_000
}
