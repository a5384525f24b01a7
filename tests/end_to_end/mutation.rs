//! What authored scenarios claim about changes of themselves: each counterfactual does as it claims. The suite judges them too
//! (`suite`); here each that does not is listed with what it did instead.

use interplay_scenarios::{Scenario, embedded, load};
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
    let changed = |scenario: &Scenario| run(name, scenario, Vec::new()).expect("the run can be finished");
    let runs: Vec<Report> = scenario.changed.par_iter().map(changed).collect();
    let mut report = film.report.clone();
    report.judge_counterfactuals(scenario, runs);
    report.counterfactuals
}

#[test]
fn authored_counterfactuals_do_as_they_claim() {
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
