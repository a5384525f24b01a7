//! Faults of a plan that do not depend on its scenarios, and time limits that no run enforces.

use super::assignment::Arm;
use super::plan::SweepPlan;
use crate::format::read::overrides::SettingPath;
use crate::format::read::tree::TomlNode;
use crate::text::error::{Fault, Place};

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

/// Whether a path is another or continues below it.
fn is_within(above: &str, path: &str) -> bool {
    path.strip_prefix(above).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// The paths that an arm sets and varies, with their places.
fn changed(arm: &Arm) -> impl Iterator<Item = (String, &Place)> {
    let set = arm.settings().iter().map(|(path, value)| (path.written(), key_of(path, value)));
    set.chain(arm.factors.iter().map(|factor| (factor.path.written(), factor.key())))
}

/// The place of the last word of a path.
fn key_of<'a>(path: &'a SettingPath, value: &'a TomlNode) -> &'a Place {
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
