//! Settings below a path.

use std::collections::BTreeMap;

use super::assignment::Arm;
use super::plan::SweepPlan;
use crate::format::json_schema::SchemaNode;
use crate::format::read::overrides::{SettingPath, schema_at};
use crate::format::read::tree::{TomlNode, TomlValue};
use crate::text::error::{Fault, Place};

/// The paths of the settings that a value replaces when it is merged into a scenario at a path; of a `kind`, with its word.
///
/// Tables, and lists whose entries have names, are merged with existing ones: an empty one replaces nothing.
pub(super) fn settings_below(path: &str, value: &TomlNode, schema: SchemaNode) -> BTreeMap<String, Option<String>> {
    let mut found = BTreeMap::new();
    collect(path, value, schema, &mut found);
    found
}

fn collect(path: &str, value: &TomlNode, schema: SchemaNode, found: &mut BTreeMap<String, Option<String>>) {
    match &value.value {
        TomlValue::Table(table) => {
            table.iter().for_each(|(key, entry)| collect(&format!("{path}.{key}"), &entry.node, schema, found));
        }
        TomlValue::Array(_)
            if schema_at(schema, path.split('.')).is_some_and(|schema| schema.merge_key().is_some()) => {}
        _ => {
            let kind = value.text().filter(|_| path.ends_with(".kind")).map(str::to_owned);
            found.insert(path.to_owned(), kind);
        }
    }
}

/// Whether a path is another or continues below it.
pub(super) fn is_within(above: &str, path: &str) -> bool {
    path.strip_prefix(above).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// The ways to remove the setting at a path.
pub(super) struct Rivals<'s> {
    /// The setting itself and all tables around it.
    above: Vec<String>,
    /// Keys that exclude the key of a table on the way to the setting: the key, and the excluding ones.
    excluding: Vec<(String, Vec<String>)>,
    /// The `kind` of a table on the way, and the kinds that do not know the setting.
    kinds: Vec<(String, Vec<&'s str>)>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Removal {
    /// By a value at this path.
    Replaced(String),
    /// By a key at this path, which excludes it.
    Excluded(String),
    /// By a `kind` at this path, with this word, which does not know it.
    Unknown(String, String),
}

impl<'s> Rivals<'s> {
    /// Those of a path without `*`.
    pub fn find(path: &str, schema: SchemaNode<'s>) -> Rivals<'s> {
        let words: Vec<&str> = path.split('.').collect();
        let up_to = |count: usize| words[..count].join(".");
        let mut rivals =
            Rivals { above: (1..=words.len()).map(up_to).collect(), excluding: Vec::new(), kinds: Vec::new() };
        for (count, word) in words.iter().enumerate().skip(1) {
            let Some(table) = schema_at(schema, words[..count].iter().copied()) else { continue };
            let others: Vec<String> = excluded(table, word).map(|other| format!("{}.{other}", up_to(count))).collect();
            if !others.is_empty() {
                rivals.excluding.push((up_to(count + 1), others));
            }
            let knows = |kind: &&str| table.of_kind(kind).is_some_and(|table| table.property(word).is_some());
            let others: Vec<&str> = table.kinds().into_iter().filter(|kind| !knows(kind)).collect();
            if *word != "kind" && !others.is_empty() {
                rivals.kinds.push((format!("{}.kind", up_to(count)), others));
            }
        }
        rivals
    }

    /// How later settings remove this one, if they do.
    pub fn removal(&self, laid: &BTreeMap<String, Option<String>>) -> Option<Removal> {
        let states = |path: &str| {
            laid.contains_key(path)
                || laid.range(format!("{path}.")..).next().is_some_and(|(next, _)| is_within(path, next))
        };
        let replaced =
            self.above.iter().find(|path| laid.contains_key(*path)).map(|path| Removal::Replaced(path.clone()));
        let excluded = || {
            let gone = self.excluding.iter().filter(|(own, _)| !states(own));
            let other = gone.flat_map(|(_, others)| others).find(|other| states(other))?;
            Some(Removal::Excluded(other.clone()))
        };
        let unknown = || {
            self.kinds.iter().find_map(|(path, kinds)| {
                let kind = laid.get(path)?.as_deref().filter(|kind| kinds.contains(kind))?;
                Some(Removal::Unknown(path.clone(), kind.to_owned()))
            })
        };
        replaced.or_else(excluded).or_else(unknown)
    }
}

/// The keys that may not stand beside a key of a table, whatever its kind.
fn excluded<'s>(table: SchemaNode<'s>, key: &str) -> impl Iterator<Item = &'s str> {
    let tables = table.kinds().into_iter().filter_map(move |kind| table.of_kind(kind)).chain([table]);
    let pairs = tables.flat_map(|table| table.exclusions().collect::<Vec<_>>());
    let of_key = pairs.filter_map(move |(one, other)| match key {
        _ if key == one => Some(other),
        _ if key == other => Some(one),
        _ => None,
    });
    of_key.collect::<Vec<_>>().into_iter()
}

/// The label of a change without effect.
pub(super) const NO_EFFECT: &str = "without effect";

impl SweepPlan {
    /// The faults of the plan that do not depend on its scenarios.
    pub(super) fn conflicts(&self) -> Vec<Fault> {
        let arms = || [&self.changes].into_iter().chain(&self.styles).chain(&self.planners);
        let seeds = arms().flat_map(Arm::settings).filter(|(path, _)| path.written() == "seed");
        let seeds: Vec<Fault> = seeds.map(|(path, value)| set_seed(key_of(path, value))).collect();
        if !seeds.is_empty() {
            return seeds;
        }
        let mut faults = self.varied_twice();
        faults.extend(self.jitter_twice());
        faults
    }

    /// Paths that vary both in all runs and with a style.
    fn varied_twice(&self) -> Vec<Fault> {
        let of_styles = self.styles.iter().flat_map(|style| &style.factors);
        let again = of_styles.filter_map(|factor| {
            let path = factor.path.written();
            let everywhere = self.changes.factors.iter().find(|other| other.path.written() == path)?;
            let message = format!("`{path}` varies in all runs and with this style, too");
            let fault = Fault::at(factor.key(), "a second time", message);
            Some(fault.also(everywhere.key(), "varies here").help("leave one of both out"))
        });
        again.collect()
    }

    /// Changes that state the random change of the starts in all runs besides the plan's own.
    fn jitter_twice(&self) -> Vec<Fault> {
        let Some(jitter) = &self.jitter_place else { return Vec::new() };
        let again = changed(&self.changes).filter(|(path, _)| is_within("start_jitter", path)).map(|(_, key)| {
            let message = "the plan has a `jitter`, and `start_jitter` is laid over it";
            let fault = Fault::at(key, "the same change of the starts", message).also(jitter, "without effect");
            fault.help("leave one of both out; `jitter` is scaled to the vehicles, `start_jitter` is taken as it is")
        });
        again.collect()
    }

    /// Changes that set a time limit of plans that no run of the plan enforces.
    pub(super) fn idle_deadlines(&self) -> Vec<Fault> {
        let enforced = |node: &TomlNode| node.to_json().to_string().contains("\"enforced\"");
        let arms = || [&self.changes].into_iter().chain(&self.styles).chain(&self.planners);
        let counterfactuals = self.scenarios.iter().flat_map(|scenario| &scenario.counterfactuals);
        let of_deadline = |arm: &Arm| arm.settings().iter().any(|(_, value)| enforced(value));
        let varies = arms().flat_map(|arm| &arm.factors).any(|factor| factor.listed().iter().any(enforced));
        let is_in_scenario = |scenario: &TomlNode| scenario.at("real_time").is_some_and(enforced);
        if varies
            || arms().chain(counterfactuals).any(of_deadline)
            || self.scenarios.iter().any(|scenario| is_in_scenario(&scenario.tree))
        {
            return Vec::new();
        }
        let idle = arms().flat_map(changed).filter(|(path, _)| is_within("real_time", path)).map(|(_, key)| {
            let message = "plans that take longer than `real_time` allows are only counted by the clock, \
                which the rows of a sweep say nothing of";
            Fault::at(key, NO_EFFECT, message).help(
                "set `real_time.deadline` to `enforced`, or see the count in the report of `interplay run`; the times themselves are \
                 in the columns `plan_median_ms` and `plan_p99_ms`",
            )
        });
        idle.collect()
    }
}

/// The paths that an arm sets and varies, with their places.
fn changed(arm: &Arm) -> impl Iterator<Item = (String, &Place)> {
    let set = arm.settings().iter().map(|(path, value)| (path.written(), key_of(path, value)));
    set.chain(arm.factors.iter().map(|factor| (factor.path.written(), factor.key())))
}

/// The place of the last word of a path.
pub(super) fn key_of<'a>(path: &'a SettingPath, value: &'a TomlNode) -> &'a Place {
    path.places().last().unwrap_or(&value.place)
}

/// The refusal of a seed that is set.
fn set_seed(place: &Place) -> Fault {
    let message = "the seed of a run follows from its sample: with one seed for all, samples that differ in nothing else would be \
                   the same run, counted several times";
    let help =
        "leave it out; a plan's own `seed` is that of its first sample, and the next samples have the seeds after it";
    Fault::at(place, "cannot be set", message).help(help)
}
