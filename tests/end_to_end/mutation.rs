//! What authored scenarios claim about changes of themselves: each counterfactual does as it claims. The suite judges them too
//! (`suite`); here each that does not is listed with what it did instead.

use interplay_scenarios::{Counterfactual, Scenario, embedded, load};
use interplay_simulation::report::{CounterfactualReport, Report};
use interplay_simulation::run::{run, run_with_counterfactuals};
use rayon::prelude::*;

use crate::film::FILMS;

/// The authored scenarios that carry counterfactuals.
fn carriers() -> Vec<(&'static str, Scenario)> {
    let all = embedded().iter().map(|file| (file.name, load(file.name, &[]).expect("authored")));
    all.filter(|(_, scenario)| !scenario.counterfactuals.is_empty()).collect()
}

/// The counterfactuals of a scenario, judged; its own run is taken from the films where there is one.
fn judged(name: &str, scenario: &Scenario) -> Vec<CounterfactualReport> {
    let Some(film) = FILMS.iter().find(|film| film.name() == name) else {
        return run_with_counterfactuals(name, scenario, Vec::new()).expect("the runs can be finished").counterfactuals;
    };
    let changed = |one: &Counterfactual| run(name, &one.scenario, Vec::new()).expect("the run can be finished");
    let runs: Vec<Report> = scenario.counterfactuals.par_iter().map(changed).collect();
    let mut report = film.report.clone();
    report.judge_counterfactuals(scenario, runs);
    report.counterfactuals
}

#[test]
fn authored_counterfactuals_meet_their_expectations() {
    let carriers = carriers();
    assert!(carriers.len() >= 2, "{} scenarios have counterfactuals", carriers.len());
    let wrong = carriers.par_iter().flat_map_iter(|(name, scenario)| {
        let judged = judged(name, scenario);
        assert_eq!(judged.len(), scenario.counterfactuals.len(), "{name}: each is judged");
        let wrong = judged.into_iter().filter(|one| !one.passed);
        wrong.map(move |one| {
            let failed: Vec<String> = one.failed().map(ToString::to_string).collect();
            format!("{name}: {}: {}", one.name, failed.join("; "))
        })
    });
    let wrong: Vec<String> = wrong.collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// In every driving figure the style of the other drivers decides the outcome, and where its planner claims a gain over the
/// conservative one, the planner's own mechanism causes it. The file must have the counterfactuals that show it; the test above
/// runs them.
#[test]
fn scenarios_of_figures_state_counterfactuals_that_support_them() {
    let mut figures = 0;
    for file in embedded() {
        let scenario = load(file.name, &[]).expect("authored");
        if scenario.figure.is_none() || scenario.vehicles.is_empty() {
            continue;
        }
        figures += 1;
        let (own, ego) = (&scenario, scenario.ego_index());
        let flips_a_style = |changed: &Scenario| {
            let drivers = |scenario: &Scenario| {
                let others = scenario.vehicles.iter().enumerate().filter(|(index, _)| *index != ego);
                others.map(|(_, vehicle)| vehicle.driver.clone()).collect::<Vec<_>>()
            };
            drivers(changed) != drivers(own)
        };
        let (kind, order) = (own.vehicles[ego].driver.kind(), own.expect.order.as_ref());
        // The changed scenario of each counterfactual, and whether it claims that the ego's place in the order changes.
        let changes: Vec<(&Scenario, bool)> = own
            .counterfactuals
            .iter()
            .map(|Counterfactual { stated, scenario: changed }| {
                let other_order = changed.expect.order.as_ref().is_some_and(|changed| Some(changed) != order);
                (changed, other_order || stated.expect.order_differs == Some(true))
            })
            .collect();
        let name = file.name;
        assert!(changes.iter().any(|(changed, reorders)| *reorders && flips_a_style(changed)), "{name}: a style");
        let is_conservative = |changed: &Scenario| changed.vehicles[ego].driver.kind() == "conservative";
        assert!(changes.iter().any(|(changed, _)| is_conservative(changed)), "{name}: the conservative planner");
        if changes.iter().any(|(changed, reorders)| *reorders && is_conservative(changed)) {
            let has_mechanism_off = |changed: &Scenario| {
                let driver = &changed.vehicles[ego].driver;
                driver.kind() == kind && *driver != own.vehicles[ego].driver
            };
            assert!(
                changes.iter().any(|(changed, reorders)| *reorders && has_mechanism_off(changed)),
                "{name}: mechanism"
            );
        }
    }
    assert_eq!(figures, 16);
}
