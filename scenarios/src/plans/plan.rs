//! A plan that has been read, and its runs.

use std::collections::BTreeMap;

use serde_json::Value as Json;

use super::assignment::{Arm, Assignment, path_of};
use super::factor::Factor;
use super::names::{self, NamedScenario};
use crate::format::read::tree::{Table, TomlNode, TomlValue};
use crate::format::registry::Registry;
use crate::load::assemble_on;
use crate::model::metric::RegisteredMetrics;
use crate::model::scenario::Scenario;
use crate::model::traffic::weights::StartJitter;
use crate::plans::plan_file::Sampling;
use crate::resolve::placement::KnownRoads;
use crate::text::error::{Fault, Place};

/// A plan of many runs. Runs are numbered from 0; runs of one sample have consecutive numbers.
pub struct SweepPlan {
    pub(super) registry: Registry,
    pub(super) name: String,
    pub(super) title: Option<String>,
    /// The text as it was written.
    pub(super) text: String,
    pub(super) scenarios: Vec<PlannedScenario>,
    pub(super) styles: Vec<Arm>,
    pub(super) planners: Vec<Arm>,
    pub(super) changes: Arm,
    pub(super) sampling: Sampling,
    pub(super) samples: u64,
    /// The place of their number, if stated.
    pub(super) samples_place: Option<Place>,
    pub(super) seed: u64,
    /// The place to blame for a key that no line states.
    pub(super) place: Place,
    /// The place of the random change of the starts, if stated.
    pub(super) jitter_place: Option<Place>,
    /// The known roads of its scenarios.
    pub(super) known_roads: KnownRoads,
}

/// A scenario of a plan, without the plan's changes.
pub(super) struct PlannedScenario {
    pub named: NamedScenario,
    pub tree: TomlNode,
    /// The scenario in words; different scenarios have different words.
    pub canonical: String,
    /// The random change of its starts, scaled to its vehicles.
    pub jitter: Option<StartJitter>,
    /// Planners of this scenario alone, after those of the plan: its counterfactuals, if they are run.
    pub counterfactuals: Vec<Arm>,
}

/// One run of a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepPoint {
    /// Its number.
    pub index: u64,
    /// The scenario's name.
    pub scenario: String,
    /// The scenario's family.
    pub family: String,
    /// The name of the drivers of the other vehicles.
    pub style: String,
    /// The name of the planner.
    pub planner: String,
    /// The sample among those of the scenario and style; the runs of all planners have the same values in it.
    pub sample: u64,
    /// The seed of the run.
    pub seed: u64,
    /// The paths that vary, with their values.
    pub inputs: Vec<(String, Json)>,
    pub(super) place: Indices,
}

/// The parts of a plan that make a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Indices {
    pub scenario: usize,
    pub style: usize,
    pub planner: usize,
    /// The combination on the grid.
    pub cell: u64,
    pub draw: u64,
}

/// A value of one of the factors that replaces the one in a run.
pub(super) struct OtherValue {
    /// Index of the factor among those of the run.
    pub factor: usize,
    pub value: TomlNode,
}

impl SweepPlan {
    /// The metrics of the registry with which the plan was read.
    pub fn metrics(&self) -> &RegisteredMetrics {
        self.registry.metrics()
    }

    /// The title of the plan.
    pub fn title(&self) -> &str {
        self.title.as_deref().unwrap_or(&self.name)
    }

    /// The plan as it was written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The number of runs of the plan.
    pub fn run_count(&self) -> u64 {
        self.count().unwrap_or(u64::MAX)
    }

    /// The same; `None` if the number overflows.
    pub(super) fn count(&self) -> Option<u64> {
        let planners = (0..self.scenarios.len()).map(|scenario| self.planner_count(scenario)).sum();
        self.samples_of_all_styles()?.checked_mul(planners)
    }

    /// How many runs there are with `scenarios` scenarios; `None` if the number overflows.
    pub(super) fn count_for(&self, scenarios: usize) -> Option<u64> {
        self.samples_of_all_styles()?.checked_mul(scenarios as u64)?.checked_mul(self.planners.len() as u64)
    }

    fn samples_of_all_styles(&self) -> Option<u64> {
        (0..self.styles.len()).try_fold(0_u64, |sum, style| sum.checked_add(self.samples_of(style)?))
    }

    /// The number of planners in a scenario: those of the plan, then the scenario's counterfactuals.
    pub(super) fn planner_count(&self, scenario: usize) -> u64 {
        (self.planners.len() + self.scenarios[scenario].counterfactuals.len()) as u64
    }

    pub(super) fn planner(&self, place: &Indices) -> &Arm {
        let own = || &self.scenarios[place.scenario].counterfactuals[place.planner - self.planners.len()];
        self.planners.get(place.planner).unwrap_or_else(own)
    }

    /// The number of counterfactuals that are run in addition to the planners.
    pub fn counterfactual_count(&self) -> usize {
        self.scenarios.iter().map(|scenario| scenario.counterfactuals.len()).sum()
    }

    /// The paths of all factors, sorted, each with whether it is numeric.
    pub fn inputs(&self) -> Vec<(String, bool)> {
        let mut found = BTreeMap::new();
        for factor in self.styles.iter().chain([&self.changes]).flat_map(|arm| &arm.factors) {
            *found.entry(factor.path.written()).or_insert(true) &= factor.is_numeric();
        }
        found.into_iter().collect()
    }

    /// The names of the scenarios, the styles and the planners.
    pub fn names(&self) -> [Vec<&str>; 3] {
        [
            self.scenarios.iter().map(|scenario| scenario.named.name.as_str()).collect(),
            self.styles.iter().map(|arm| arm.name.as_str()).collect(),
            self.planners.iter().map(|arm| arm.name.as_str()).collect(),
        ]
    }

    /// The number of combinations with a style.
    fn cells(&self, style: usize) -> Option<u64> {
        if self.sampling != Sampling::Grid {
            return Some(1);
        }
        let counts = self.factors(style).filter_map(Factor::count);
        counts.map(|count| count as u64).try_fold(1_u64, u64::checked_mul)
    }

    fn samples_of(&self, style: usize) -> Option<u64> {
        self.cells(style)?.checked_mul(self.samples)
    }

    pub(super) fn factors(&self, style: usize) -> impl Iterator<Item = &Factor> {
        self.changes.factors.iter().chain(&self.styles[style].factors)
    }

    /// A run.
    ///
    /// # Panics
    /// If `index` is not below the number of runs.
    pub fn point(&self, index: u64) -> SweepPoint {
        assert!(index < self.run_count(), "the plan has no run {index}");
        let mut rest = index;
        let mut style = 0;
        let planners = (0..self.scenarios.len()).map(|scenario| self.planner_count(scenario)).sum::<u64>();
        // Samples of a style, for one scenario after the other, with all planners of the scenario.
        while rest >= self.samples_of(style).unwrap_or(u64::MAX).saturating_mul(planners) {
            rest -= self.samples_of(style).unwrap_or(0) * planners;
            style += 1;
        }
        let of_one = self.samples_of(style).unwrap_or(1);
        let mut scenario = 0;
        while rest >= of_one.saturating_mul(self.planner_count(scenario)) {
            rest -= of_one * self.planner_count(scenario);
            scenario += 1;
        }
        let (sample, planner) = (rest / self.planner_count(scenario), (rest % self.planner_count(scenario)) as usize);
        let place = Indices { scenario, style, planner, cell: sample / self.samples, draw: sample % self.samples };
        let named = &self.scenarios[scenario].named;
        let inputs = self.values(&place).map(|(factor, value)| (factor.path.written(), value.to_json())).collect();
        SweepPoint {
            index,
            scenario: named.name.clone(),
            family: named.family.clone(),
            style: self.styles[style].name.clone(),
            planner: self.planner(&place).name.clone(),
            sample,
            seed: self.seed + place.draw,
            inputs,
            place,
        }
    }

    /// The values of all factors in a run.
    pub(super) fn values(&self, place: &Indices) -> impl Iterator<Item = (&Factor, TomlNode)> {
        let (mut cell, draw, is_grid) = (place.cell, place.draw, self.sampling == Sampling::Grid);
        self.factors(place.style).map(move |factor| {
            let value = match factor.count().filter(|_| is_grid) {
                Some(count) => {
                    let index = cell % count as u64;
                    cell /= count as u64;
                    factor.value(index as usize)
                }
                None => factor.drawn(draw),
            };
            (factor, value)
        })
    }

    /// The scenario of a run in words, without the plan's changes; different scenarios have different words.
    pub fn canonical_scenario(&self, point: &SweepPoint) -> &str {
        &self.scenarios[point.place.scenario].canonical
    }

    /// The changes of a run in words; different changes have different words.
    pub fn canonical_changes(&self, point: &SweepPoint) -> String {
        let place = &point.place;
        let jitter = self.scenarios[place.scenario].jitter;
        let jitter = jitter.map(|jitter| format!("jitter={:?}\n", jitter)).unwrap_or_default();
        let arms = [&self.changes, &self.styles[place.style], self.planner(place)];
        let arms = arms.map(Arm::canonical).join("\n;\n");
        let inputs: Vec<String> = point.inputs.iter().map(|(path, value)| format!("{path}={value}")).collect();
        let files = self.named_files(place);
        format!("{jitter}{arms}\n;\n{}\n;\nseed={}\n;\n{files}", inputs.join("\n"), point.seed)
    }

    /// The contents of the files that a run names because of the plan; `None` if the plan changes none of them.
    fn named_files(&self, place: &Indices) -> String {
        let assignments = self.assignments(place, None);
        if !assignments.iter().any(|assignment| assignment.is_below(&names::SETTINGS)) {
            return String::new();
        }
        self.assembled(place, &assignments).map_or_else(|_| String::new(), |scenario| names::contents(&scenario))
    }

    /// The plan's changes of the scenario in a run, in the order in which they are merged into it: the random change of the starts,
    /// the settings of all runs, the style, the planner, and the factors; `instead`, if stated, replaces the value of one of them.
    pub(super) fn assignments(&self, place: &Indices, instead: Option<&OtherValue>) -> Vec<Assignment<'_>> {
        let jitter = self.jitter_place.as_ref().zip(self.scenarios[place.scenario].jitter);
        let jitter = jitter.into_iter().flat_map(|(written, jitter)| Assignment::of_jitter(jitter, written));
        let arms = [&self.changes, &self.styles[place.style], self.planner(place)];
        let varied = self.values(place).enumerate().map(|(index, (factor, value))| {
            let other = instead.filter(|other| other.factor == index).map(|other| other.value.clone());
            Assignment::varied(&factor.path, other.unwrap_or(value))
        });
        jitter.chain(arms.into_iter().flat_map(Arm::assignments)).chain(varied).collect()
    }

    /// The scenario of a run with these changes and its seed.
    pub(super) fn assembled<'a>(
        &self,
        place: &Indices,
        assignments: impl IntoIterator<Item = &'a Assignment<'a>>,
    ) -> Result<Scenario, Vec<Fault>> {
        let tree = self.laid(place, assignments).map_err(|fault| vec![fault])?;
        assemble_on(&self.registry, &tree, &self.known_roads)
    }

    /// The same, unchecked.
    pub(super) fn laid<'a>(
        &self,
        place: &Indices,
        assignments: impl IntoIterator<Item = &'a Assignment<'a>>,
    ) -> Result<TomlNode, Fault> {
        let mut tree = self.scenarios[place.scenario].tree.clone();
        if let TomlValue::Table(root) = &mut tree.value {
            self.lay(root, place, assignments)?;
        }
        Ok(tree)
    }

    fn lay<'a>(
        &self,
        root: &mut Table,
        place: &Indices,
        assignments: impl IntoIterator<Item = &'a Assignment<'a>>,
    ) -> Result<(), Fault> {
        let seed = TomlValue::Integer(i128::from(self.seed + place.draw));
        let (schema, seed) = (self.registry.complete(), TomlNode { place: self.place.clone(), value: seed });
        path_of("seed", &self.place)?.lay(root, &seed, schema)?;
        assignments.into_iter().try_for_each(|assignment| assignment.lay(root, schema))
    }
}
