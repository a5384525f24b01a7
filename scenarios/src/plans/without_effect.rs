//! Changes of a plan that later changes undo.
//!
//! In each run a plan merges into the scenario, in this order: the change of the starts, the settings of all runs, the style, the
//! planner, the factors of all runs, and the factors of the style. A value in the scenario keeps its place in the plan until a later
//! change replaces it, excludes it, or is of a kind that does not know it: a change has an effect as long as its places are there.
//!
//! A setting must have an effect in at least one run. A factor must have an effect wherever it varies, since the rows of all these
//! runs state its value.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::assignment::Assignment;
use super::conflicts::NO_EFFECT;
use super::factor::Factor;
use super::plan::{Indices, SweepPlan};
use crate::format::read::tree::{Table, TomlNode, TomlValue};
use crate::model::scenario::Scenario;
use crate::plans::plan_file::Sampling;
use crate::text::error::{Fault, Place, quoted};

/// The most values of a list that are laid over the scenario.
const MAX_VALUES: usize = 100;

/// Where a value of a scenario is written: the document, by its address, the span, and the last word.
type Mark = (usize, usize, usize, String);

/// A change of a plan in one run: a setting with its value, or a factor with its different values.
struct Change<'a> {
    /// The part of the plan that states it, in words.
    by: &'a str,
    values: Vec<Assignment<'a>>,
    is_of_counterfactual: bool,
}

/// A value of a change that is in the scenario.
struct Setting<'c> {
    mark: Mark,
    path: String,
    change: &'c Change<'c>,
}

#[derive(Default)]
struct Effects {
    /// Why a setting has no effect, by its place and path; `None` if it has one in some run.
    settings: BTreeMap<(usize, usize, String), Option<Fault>>,
    factors: BTreeMap<(usize, usize), Fault>,
}

impl SweepPlan {
    /// The settings without effect in any run, and the factors without effect in some.
    pub(super) fn without_effect(&self) -> Vec<Fault> {
        let mut effects = Effects::default();
        for scenario in 0..self.scenarios.len() {
            for style in 0..self.styles.len() {
                for planner in 0..self.planner_count(scenario) as usize {
                    self.note(&Indices { scenario, style, planner, cell: 0, draw: 0 }, &mut effects);
                }
            }
        }
        // One refusal for each change, even if it states several settings.
        let mut found = effects.factors;
        for fault in effects.settings.into_values().flatten() {
            if let Some(place) = fault.place() {
                found.entry(span(place)).or_insert(fault);
            }
        }
        found.into_values().collect()
    }

    /// Notes the effect of each change with one scenario, style and planner. A change that cannot be laid over the scenario is
    /// refused elsewhere.
    fn note(&self, place: &Indices, effects: &mut Effects) {
        let (scenario, style) = (&self.scenarios[place.scenario], &self.styles[place.style]);
        let TomlValue::Table(mut root) = scenario.tree.value.clone() else { return };
        let (planner, is_counterfactual) = (self.planner(place), place.planner >= self.planners.len());
        let of_scenario = || format!("{} with its counterfactual", quoted(&scenario.named.name));
        let by_style = format!("the style {}", quoted(&style.name));
        let by_planner = if is_counterfactual { of_scenario() } else { "the planner".to_owned() };
        let by_planner = format!("{by_planner} {}", quoted(&planner.name));
        let arms = [
            (&self.changes, "the plan", false),
            (style, by_style.as_str(), false),
            (planner, by_planner.as_str(), is_counterfactual),
        ];
        let fixed = arms.iter().flat_map(|&(arm, by, is_of_counterfactual)| {
            arm.assignments().map(move |one| Change { by, values: vec![one], is_of_counterfactual })
        });
        let factors = arms.iter().flat_map(|&(arm, by, is_of_counterfactual)| {
            arm.factors.iter().map(move |one| Change { by, values: different(one), is_of_counterfactual })
        });
        let (fixed, factors): (Vec<Change>, Vec<Change>) = (fixed.collect(), factors.collect());
        let mut settings: Vec<Setting> = Vec::new();
        for change in &fixed {
            if change.values[0].lay(&mut root, self.registry.complete()).is_err() {
                return;
            }
            let marks = marks(&root);
            settings.retain(|setting| marks.contains(&setting.mark) || effects.undone(setting, change, &root));
            settings.extend(change.settings(&change.values[0], &root, &marks));
        }
        for (index, factor) in factors.iter().enumerate() {
            let laid: Vec<BTreeSet<Mark>> =
                factor.values.iter().filter_map(|one| Some(self.laid_over(&root, one)?.1)).collect();
            let is_kept = |setting: &Setting| laid.is_empty() || laid.iter().any(|marks| marks.contains(&setting.mark));
            settings.retain(|setting| is_kept(setting) || effects.undone(setting, factor, &root));
            if place.planner == 0 {
                let undone = factors[index + 1..].iter().find_map(|later| self.undone_in_part(&root, factor, later));
                if let Some(fault) = undone {
                    effects.factors.entry(span(factor.key())).or_insert(fault);
                }
            }
        }
        for setting in settings.iter().filter(|setting| !setting.change.is_of_counterfactual) {
            effects.settings.insert(setting.key(), None);
        }
    }

    /// The scenario with one more change, and the places of its values.
    fn laid_over(&self, root: &Table, change: &Assignment<'_>) -> Option<(Table, BTreeSet<Mark>)> {
        let mut root = root.clone();
        change.lay(&mut root, self.registry.complete()).ok()?;
        let marks = marks(&root);
        Some((root, marks))
    }

    /// The fault of a factor of which a value is undone by a value of a later one.
    fn undone_in_part(&self, root: &Table, factor: &Change, later: &Change) -> Option<Fault> {
        factor.values.iter().find_map(|own| {
            let (root, marks) = self.laid_over(root, own)?;
            let settings = factor.settings(own, &root, &marks);
            later.values.iter().find_map(|other| {
                let (root, marks) = self.laid_over(&root, other)?;
                let undone = settings.iter().find(|setting| !marks.contains(&setting.mark))?;
                Some(undone.fault(later, &root))
            })
        })
    }
}

fn marks(root: &Table) -> BTreeSet<Mark> {
    let mut marks = BTreeSet::new();
    for (key, entry) in root {
        each_value(&mut vec![key.as_str()], &entry.node, &mut |words, place| {
            marks.insert(mark(words, place));
        });
    }
    marks
}

impl Effects {
    /// Notes that a change undoes a setting; false.
    fn undone(&mut self, setting: &Setting, other: &Change, root: &Table) -> bool {
        if !setting.change.is_of_counterfactual {
            self.settings.entry(setting.key()).or_insert_with(|| Some(setting.fault(other, root)));
        } else if other.is_varied() {
            let message =
                format!("{} sets `{}`, and what varies here is laid over it", setting.change.by, setting.path);
            let fault = Fault::at(other.key(), "the counterfactual is without effect", message);
            let help = "leave it out of `vary`, or run without the counterfactuals";
            self.factors.entry(span(other.key())).or_insert_with(|| fault.help(help));
        }
        false
    }
}

impl Change<'_> {
    fn key(&self) -> &Place {
        self.values[0].key()
    }

    fn is_varied(&self) -> bool {
        self.values[0].is_varied
    }

    /// The settings of one of its values that are among those in a scenario.
    fn settings<'c>(&'c self, value: &Assignment<'_>, root: &Table, marks: &BTreeSet<Mark>) -> Vec<Setting<'c>> {
        let path = value.path(root);
        let (mut words, mut found) = (path.split('.').collect(), Vec::new());
        each_value(&mut words, value.value(), &mut |words, place| {
            let mark = mark(words, place);
            if marks.contains(&mark) {
                found.push(Setting { mark, path: words.join("."), change: self });
            }
        });
        found
    }
}

impl Setting<'_> {
    fn key(&self) -> (usize, usize, String) {
        let (from, to) = span(self.change.key());
        (from, to, self.path.clone())
    }

    /// The refusal of a setting that another change undoes.
    fn fault(&self, other: &Change, root: &Table) -> Fault {
        let states = if self.change.is_varied() { "varies" } else { "is set" };
        let (verb, wins) = if other.is_varied() { ("varies", "varies here") } else { ("sets", "wins") };
        let whole = other.values[0].path(root);
        let mut stated: Vec<String> = Vec::new();
        each_value(&mut whole.split('.').collect(), other.values[0].value(), &mut |words, _| {
            stated.push(words.join("."))
        });
        // The same setting, the only one, or the table of several.
        let is_same = |path: &String| {
            path.split('.').count() == self.path.split('.').count()
                && path.split('.').zip(self.path.split('.')).all(|(one, own)| one == own || [one, own].contains(&"*"))
        };
        let path = match (stated.iter().find(|path| is_same(path)), stated.as_slice()) {
            (Some(path), _) => path,
            (None, [path]) if !other.is_varied() => path,
            (None, _) => &whole,
        };
        let (setting, by) = (&self.path, other.by);
        let message = format!("`{setting}` {states} here, and {by} {verb} `{path}`, which is laid over it");
        Fault::at(self.change.key(), NO_EFFECT, message).also(other.key(), wins).help(HELP)
    }
}

fn span(place: &Place) -> (usize, usize) {
    (place.span.start, place.span.end)
}

fn mark(words: &[&str], place: &Place) -> Mark {
    let document = Arc::as_ptr(&place.document).addr();
    (document, place.span.start, place.span.end, words.last().copied().unwrap_or_default().to_owned())
}

/// Visits each value that is not a table, with the words that lead to it.
fn each_value<'t>(words: &mut Vec<&'t str>, node: &'t TomlNode, visit: &mut dyn FnMut(&[&str], &Place)) {
    match &node.value {
        TomlValue::Table(table) => {
            for (key, entry) in table {
                words.push(key);
                each_value(words, &entry.node, visit);
                words.pop();
            }
        }
        TomlValue::Array(items) if items.iter().any(|item| item.table().is_some()) => {
            items.iter().for_each(|item| each_value(words, item, visit));
        }
        _ => visit(words, &node.place),
    }
}

/// The values of a factor that may replace different settings: each table and word of a list, and one number.
fn different(factor: &Factor) -> Vec<Assignment<'_>> {
    let is_number = |node: &TomlNode| matches!(node.value, TomlValue::Integer(_) | TomlValue::Float(_));
    let listed = factor.listed().iter().take(MAX_VALUES).filter(|node| !is_number(node)).cloned();
    let mut values: Vec<TomlNode> = listed.collect();
    if values.is_empty() {
        values.push(factor.value(0));
    }
    values.into_iter().map(|value| Assignment::varied(&factor.path, value)).collect()
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
