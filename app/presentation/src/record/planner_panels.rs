//! Panels for the diagnostics of planners. The planners declare their diagnostics and how to group them
//! ([`interplay_planners::plan::diagnostic`]); this module derives paths, panels and an explanatory text.

use interplay_planners::perception::belief::diagnostics::PANELS as BELIEF_PANELS;
use interplay_planners::plan::diagnostic::{COMMON_PANELS, DiagnosticPanel, DiagnosticQuantity, Explanation};
use interplay_scenarios::{Scenario, Vehicle};

/// Space above and below a curve that runs along its bound, as a share of the range.
const RANGE_MARGIN_SHARE: f64 = 0.05;

pub struct PlannerPanel {
    /// The kind of planner that it shows; `None` for all kinds.
    pub kind: Option<&'static str>,
    pub content: &'static DiagnosticPanel,
}

impl PlannerPanel {
    /// The ends of the vertical axis, if the range of the quantities is known.
    pub fn axis(&self) -> Option<[f64; 2]> {
        let [low, high] = self.content.bounds()?;
        let margin = RANGE_MARGIN_SHARE * (high - low);
        Some([low - margin, high + margin])
    }
}

/// The panels of a scenario: those of its planners, the ego's first; those of beliefs, if plans are inferred; the common ones.
pub fn panels(scenario: &Scenario) -> Vec<PlannerPanel> {
    let own = explanations(scenario).into_iter().flat_map(|(kind, explanation)| {
        explanation.panels.iter().map(move |content| PlannerPanel { kind: Some(kind), content })
    });
    let infers = scenario.vehicles.iter().any(|vehicle| !vehicle.driver.knows_plans());
    let beliefs = if infers { BELIEF_PANELS } else { &[] };
    own.chain(beliefs.iter().chain(COMMON_PANELS).map(|content| PlannerPanel { kind: None, content })).collect()
}

/// Explanations of the panels of a scenario as Markdown.
pub fn guide(scenario: &Scenario) -> String {
    let guides = explanations(scenario).into_iter().map(|(_, explanation)| explanation.guide);
    guides.filter(|guide| !guide.is_empty()).map(|guide| format!("\n{guide}\n")).collect()
}

/// Every kind of planner in a scenario once, the ego's first.
fn explanations(scenario: &Scenario) -> Vec<(&'static str, &'static Explanation)> {
    let mut found: Vec<(&str, &Explanation)> = Vec::new();
    for Vehicle { driver, .. } in scenario.ego().into_iter().chain(&scenario.vehicles) {
        if found.iter().all(|(kind, _)| *kind != driver.kind()) {
            found.push((driver.kind(), driver.explanation()));
        }
    }
    found
}

/// The index of a quantity in its panel.
pub fn place(explanation: &Explanation, quantity: &DiagnosticQuantity) -> Option<usize> {
    let mut panels = explanation.panels.iter().chain(BELIEF_PANELS).chain(COMMON_PANELS);
    panels.find_map(|panel| panel.quantities.iter().position(|other| other.name == quantity.name))
}

/// The name of a quantity in paths: letters, digits, `_` and `-`.
pub fn slug(quantity: &DiagnosticQuantity) -> String {
    let allowed = |character: &char| character.is_ascii_alphanumeric() || "_- ".contains(*character);
    let letters = quantity.name.chars().filter(allowed);
    letters.map(|character| if character == ' ' { '-' } else { character }).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use interplay_planners::perception::belief::diagnostics::QUANTITIES as BELIEF_QUANTITIES;
    use interplay_planners::plan::diagnostic::{COMMON_QUANTITIES, ValueSet};
    use interplay_scenarios::{Override, Registry, load};

    use super::*;

    #[test]
    fn path_names_of_quantities_contain_only_letters_digits_and_dashes() {
        let named = |name| slug(&DiagnosticQuantity::new(name, "", ValueSet::Real));
        assert_eq!(named("other's loyalty w_1"), "others-loyalty-w_1");
        assert_eq!(named("payoff ego: both yield"), "payoff-ego-both-yield");
    }

    /// Otherwise two curves of one planner would share a path.
    #[test]
    fn quantities_of_a_planner_have_different_path_names() {
        // These do not plan for a vehicle, or need a file, and have no diagnostics.
        let others = ["external", "inputs", "recorded", "walker"];
        for kind in Registry::standard().driver_kinds().into_iter().filter(|kind| !others.contains(kind)) {
            let scenario =
                load("lane-change/front-nice", &[Override::Planner(kind.to_owned())]).expect("every kind may drive");
            let (_, explanation) = explanations(&scenario)[0];
            let quantities = || explanation.quantities.iter().chain(BELIEF_QUANTITIES).chain(COMMON_QUANTITIES);
            let slugs: BTreeSet<String> = quantities().map(slug).collect();
            assert_eq!(slugs.len(), quantities().count(), "{kind}");
        }
    }
}
