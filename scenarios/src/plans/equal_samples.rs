//! Samples of a plan that would repeat the same run.

use super::assignment::Assignment;
use super::factor::Factor;
use super::plan::{Indices, SweepPlan};
use crate::model::scenario::Scenario;
use crate::plans::plan_file::Sampling;
use crate::text::error::{Fault, quoted};

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
