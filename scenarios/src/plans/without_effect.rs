//! Changes of a plan that later changes undo.
//!
//! In each run a plan merges into the scenario, in this order: the change of the starts, the settings of all runs, the style, the
//! planner, the factors of all runs, and the factors of the style. A later setting undoes an earlier one if it states it or a table
//! around it, excludes it, or is of a kind that does not know it.
//!
//! A setting must have an effect in at least one run. A factor must have an effect wherever it varies, since the rows of all these
//! runs state its value.

use std::collections::{BTreeMap, BTreeSet};

use super::assignment::{Arm, Assignment};
use super::factor::Factor;
use super::plan::{Indices, PlannedScenario, SweepPlan};
use super::settings_below::{NO_EFFECT, Removal, Rivals, key_of, settings_below};
use crate::format::json_schema::SchemaNode;
use crate::format::read::overrides::{OTHER_VEHICLES, SettingPath, ego_kind};
use crate::format::read::tree::{Table, TomlNode, TomlValue};
use crate::model::scenario::Scenario;
use crate::plans::plan_file::Sampling;
use crate::text::error::{Fault, Place, quoted};

/// The settings that a value of a change replaces in a scenario; of a `kind`, with its word.
type Settings = BTreeMap<String, Option<String>>;

/// A scenario as it is written, and the schema of scenarios.
type Root<'a, 'r> = (&'r Table, SchemaNode<'a>);

/// A change of a plan in one scenario.
struct Change<'a> {
    /// The part of the plan that states it, in words.
    by: String,
    key: &'a Place,
    is_varied: bool,
    /// Whether it applies to every vehicle but the ego.
    is_of_others: bool,
    /// Its settings, as the plan writes them, each with the ways to remove it from the vehicles that it applies to.
    settings: BTreeMap<String, Vec<Rivals<'a>>>,
    /// The settings that each of its values replaces, equal ones once.
    values: BTreeSet<Settings>,
}

type Changes<'a> = Vec<Change<'a>>;

/// The effect of a setting at a place of the plan.
#[derive(Default)]
struct Effect {
    is_seen: bool,
    /// Why it has no effect, in the first such run.
    undone: Option<Fault>,
}

/// The settings of a plan by their places.
type Effects = BTreeMap<(usize, usize, String), Effect>;

impl SweepPlan {
    /// The settings without effect in any run, and the factors without effect in some.
    pub(super) fn without_effect(&self) -> Vec<Fault> {
        let mut effects = Effects::new();
        let mut varied: BTreeMap<(usize, usize), Fault> = BTreeMap::new();
        for scenario in &self.scenarios {
            let TomlValue::Table(root) = &scenario.tree.value else { continue };
            let root = (root, self.registry.complete());
            let everywhere = changes(&self.changes, "the plan", root);
            let (fixed, factors) = everywhere.split_at(everywhere.len() - self.changes.factors.len());
            let (planners, counterfactuals) = self.planners_of(scenario, root);
            for style in &self.styles {
                let own = changes(style, &format!("the style {}", quoted(&style.name)), root);
                let (set, own_factors) = own.split_at(own.len() - style.factors.len());
                let factors: Vec<&Change> = factors.iter().chain(own_factors).collect();
                for (index, factor) in factors.iter().enumerate() {
                    if let Some(fault) = factor.undone_in_part(&factors[index + 1..]) {
                        varied.entry(span(factor.key)).or_insert(fault);
                    }
                }
                for planner in &planners {
                    let laid: Vec<&Change> = fixed.iter().chain(set).chain(planner).collect();
                    note(&laid, laid.len(), &factors, &mut effects);
                }
                for counterfactual in &counterfactuals {
                    let laid: Vec<&Change> = fixed.iter().chain(set).chain(counterfactual).collect();
                    note(&laid, laid.len() - counterfactual.len(), &factors, &mut effects);
                    for change in counterfactual {
                        if let Some((factor, fault)) = change.undone_by_factor(&factors) {
                            varied.entry(span(factor.key)).or_insert(fault);
                        }
                    }
                }
            }
        }
        let idle = effects.into_values().filter(|effect| !effect.is_seen).filter_map(|effect| effect.undone);
        // One refusal for each change, even if it states several settings.
        let mut found: BTreeMap<(usize, usize), Fault> = varied;
        for fault in idle {
            if let Some(place) = fault.place() {
                found.entry(span(place)).or_insert(fault);
            }
        }
        found.into_values().collect()
    }

    /// The changes of the planners and of the counterfactuals of a scenario.
    fn planners_of<'a>(
        &'a self,
        scenario: &'a PlannedScenario,
        root: Root<'a, '_>,
    ) -> (Vec<Changes<'a>>, Vec<Changes<'a>>) {
        let named = |what: &str, arm: &'a Arm| changes(arm, &format!("{what} {}", quoted(&arm.name)), root);
        let planners = self.planners.iter().map(|arm| named("the planner", arm));
        let of_scenario = format!("{} with its counterfactual", quoted(&scenario.named.name));
        let counterfactuals = scenario.counterfactuals.iter().map(|arm| named(&of_scenario, arm));
        (planners.collect(), counterfactuals.collect())
    }
}

/// Notes for each setting of the first `count` changes of one run whether it has an effect.
fn note(laid: &[&Change], count: usize, factors: &[&Change], effects: &mut Effects) {
    for (index, change) in laid[..count].iter().enumerate() {
        let later = || laid[index + 1..].iter().chain(factors).copied();
        for (setting, places) in &change.settings {
            let (from, to) = span(change.key);
            let effect = effects.entry((from, to, setting.clone())).or_default();
            if effect.is_seen || places.is_empty() {
                continue;
            }
            let mut undone = None;
            effect.is_seen = !places.iter().all(|rivals| {
                undone = later().find_map(|other| Some((other, other.removal_by_all(rivals)?)));
                undone.is_some()
            });
            if let Some((other, removal)) = undone.filter(|_| !effect.is_seen) {
                effect.undone.get_or_insert_with(|| change.fault(setting, other, &removal));
            }
        }
    }
}

fn span(place: &Place) -> (usize, usize) {
    (place.span.start, place.span.end)
}

/// The changes of an arm in a scenario: the driver of the ego, its settings, then the factors.
fn changes<'a>(arm: &'a Arm, by: &str, root: Root<'a, '_>) -> Changes<'a> {
    let change = |path: &SettingPath, key, values: &mut dyn Iterator<Item = &TomlNode>, is_varied| {
        Change::new(by, path, key, values, is_varied, root)
    };
    let kind =
        arm.kind().map(|kind| change(&ego_kind(root.0, &kind.place), &kind.place, &mut [kind].into_iter(), false));
    let set =
        arm.settings().iter().map(|(path, value)| change(path, key_of(path, value), &mut [value].into_iter(), false));
    let varied = arm.factors.iter().map(|factor: &Factor| {
        let number = TomlNode { place: factor.place.clone(), value: TomlValue::Float(0.0) };
        let values = if factor.listed().is_empty() { std::slice::from_ref(&number) } else { factor.listed() };
        change(&factor.path, factor.key(), &mut values.iter(), true)
    });
    kind.into_iter().chain(set).chain(varied).collect()
}

impl<'a> Change<'a> {
    fn new(
        by: &str,
        path: &SettingPath,
        key: &'a Place,
        values: &mut dyn Iterator<Item = &TomlNode>,
        is_varied: bool,
        (root, schema): Root<'a, '_>,
    ) -> Change<'a> {
        let (mut settings, mut all) = (BTreeMap::new(), BTreeSet::new());
        let (written, paths) = (path.written(), path.in_scenario(root));
        for value in values {
            for setting in settings_below(&written, value, schema).into_keys() {
                let below = setting.strip_prefix(&written).unwrap_or_default();
                let of = |path: &SettingPath| Rivals::find(&format!("{}{below}", path.written()), schema);
                let rivals = || paths.iter().map(of).collect();
                settings.entry(setting.clone()).or_insert_with(rivals);
            }
            all.insert(paths.iter().flat_map(|path| settings_below(&path.written(), value, schema)).collect());
        }
        Change { by: by.to_owned(), key, is_varied, is_of_others: path.is_of_others(), settings, values: all }
    }

    /// A path of one of its settings in a scenario as the plan writes it.
    fn written(&self, path: &str) -> String {
        let mut words: Vec<&str> = path.split('.').collect();
        if let Some(name) = words.get_mut(1).filter(|_| self.is_of_others) {
            *name = OTHER_VEHICLES;
        }
        words.join(".")
    }

    /// How all its values remove a setting, if they do: as the first does.
    fn removal_by_all(&self, rivals: &Rivals) -> Option<Removal> {
        let removals: Option<Vec<Removal>> = self.values.iter().map(|value| rivals.removal(value)).collect();
        removals?.into_iter().next()
    }

    /// The fault of a factor of which a value is undone in all vehicles by a value of later ones.
    fn undone_in_part(&self, later: &[&Change]) -> Option<Fault> {
        self.settings.iter().filter(|(_, places)| !places.is_empty()).find_map(|(setting, places)| {
            let by = |rivals: &Rivals| {
                later
                    .iter()
                    .find_map(|other| Some((*other, other.values.iter().find_map(|value| rivals.removal(value))?)))
            };
            let undone: Option<Vec<(&Change, Removal)>> = places.iter().map(by).collect();
            let (other, removal) = undone?.into_iter().next()?;
            Some(self.fault(setting, other, &removal))
        })
    }

    /// The fault of a factor that undoes this change of a counterfactual.
    fn undone_by_factor<'b>(&self, factors: &[&'b Change<'b>]) -> Option<(&'b Change<'b>, Fault)> {
        self.settings.iter().filter(|(_, places)| !places.is_empty()).find_map(|(setting, places)| {
            let by = |rivals: &Rivals| factors.iter().find(|factor| factor.removal_by_all(rivals).is_some()).copied();
            let factor = places.iter().map(by).collect::<Option<Vec<_>>>()?.into_iter().next()?;
            let message = format!("{} sets `{setting}`, and what varies here is laid over it", self.by);
            let help = "leave it out of `vary`, or run without the counterfactuals";
            Some((factor, Fault::at(factor.key, "the counterfactual is without effect", message).help(help)))
        })
    }

    /// The refusal of a setting that another change removes.
    fn fault(&self, setting: &str, other: &Change, removal: &Removal) -> Fault {
        let (states, verb) =
            (if self.is_varied { "varies" } else { "is set" }, if other.is_varied { "varies" } else { "sets" });
        let by = |path: &str| format!("{} {verb} `{}`", other.by, other.written(path));
        let wins = match removal {
            Removal::Replaced(_) if other.is_varied && !self.is_varied => {
                "varies: what varies is laid over it".to_owned()
            }
            Removal::Replaced(path) => format!("{}, which is laid over it", by(path)),
            Removal::Excluded(path) => format!("{}, which excludes it and is laid over it", by(path)),
            Removal::Unknown(path, kind) => {
                format!("{}, of which the kind `{kind}` is laid over it and does not know it", by(path))
            }
        };
        let message = format!("`{setting}` {states} here, and {wins}");
        let fault = Fault::at(self.key, NO_EFFECT, message);
        let wins = if other.is_varied { "varies here" } else { "wins" };
        fault.also(other.key, wins).help(HELP)
    }
}

/// The help for a change without effect.
const HELP: &str = "leave one of both out; the later wins of: `set` of all runs, the style, the planner with its `kind` before its \
    `set`, what varies in all runs, what varies with the style";

impl SweepPlan {
    /// The fault of several samples of a run in which nothing is drawn. `instead`, if stated, is the value of one of its
    /// factors, which the scenario has.
    pub(super) fn equal_samples(
        &self,
        place: &Indices,
        instead: Option<&Assignment<'_>>,
        scenario: &Scenario,
    ) -> Option<Fault> {
        let written = self.samples_place.as_ref().filter(|_| self.samples > 1)?;
        if scenario.depends_on_seed() || self.factors(place.style).any(|factor| self.is_drawn(factor)) {
            return None;
        }
        let name = quoted(&self.scenarios[place.scenario].named.name);
        let (style, planner) = (quoted(&self.styles[place.style].name), quoted(&self.planner(place).name));
        let value = instead.map(|value| format!(" and {}", value.written())).unwrap_or_default();
        let message = format!(
            "nothing is drawn for {name} with the style {style} and the planner {planner}{value}: its {} samples are the same run, \
             and would be counted as many",
            self.samples
        );
        let help = if scenario.vehicles.is_empty() {
            "let a value vary by `uniform`, `normal` or `log_uniform`, or leave the number of samples out"
        } else {
            "let the starts vary with `jitter` (on the command line state `--starts` in place of `--samples`), or a value by \
             `uniform`, `normal` or `log_uniform`; otherwise leave the number of samples out"
        };
        Some(Fault::at(written, "one run", message).help(help))
    }

    /// Whether a factor has a value of its own in each sample.
    fn is_drawn(&self, factor: &Factor) -> bool {
        match self.sampling {
            Sampling::Grid => factor.count().is_none(),
            Sampling::Random | Sampling::LatinHypercube => factor.count() != Some(1),
        }
    }
}
