//! Judges whether a counterfactual fulfils its expectations, by itself and relative to the scenario's own run.

use interplay_scenarios::{CompletionShift, CounterfactualConfig, Scenario};
use serde_json::json;

use super::judge::judge;
use super::outcome::{CounterfactualReport, Expectation, Report};

/// Times that differ by less are equal \[s\]: times are multiples of far longer steps.
const TIME_TOLERANCE_S: f64 = 1e-9;

/// Judges a counterfactual of `scenario`: `main` is the scenario's own run, `run` that of the counterfactual.
pub(super) fn judge_counterfactual(
    counterfactual: &CounterfactualConfig,
    scenario: &Scenario,
    main: &Report,
    run: Report,
) -> CounterfactualReport {
    let expect = &counterfactual.expect;
    let mut expectations = Vec::new();
    if let Some(want) = expect.order_differs {
        let got = run.order != main.order;
        let what = "order_differs".to_owned();
        expectations.push(Expectation::new(what, json!(want), json!(got), want == got));
    }
    expectations.extend(expect.later.iter().map(|shift| later(shift, main, &run)));
    expectations.extend(expect.earlier.iter().map(|shift| earlier(shift, main, &run)));
    expectations.extend(expect.breaks.as_ref().map(|names| breaks(names, scenario, &run)));
    expectations.extend(run.expectations.iter().cloned());
    CounterfactualReport {
        name: counterfactual.name.clone(),
        passed: expectations.iter().all(|expectation| expectation.passed),
        order: run.order.clone(),
        expectations,
        digest: run.digest.clone(),
        run: Box::new(run),
    }
}

fn completed_s(report: &Report, name: &str) -> Option<f64> {
    report.vehicle(name).and_then(|vehicle| vehicle.completed_s)
}

/// Whether a vehicle that reaches its goal in the scenario's own run does so later in the counterfactual, or never.
fn later(shift: &CompletionShift, main: &Report, run: &Report) -> Expectation {
    let [in_main, here] = [main, run].map(|report| completed_s(report, &shift.vehicle));
    let passed = in_main.is_some_and(|before| here.unwrap_or(f64::INFINITY) - before >= shift.by_s - TIME_TOLERANCE_S);
    compared("later", shift, [in_main, here], passed)
}

/// Whether a vehicle reaches its goal earlier than in the scenario's own run, or only in the counterfactual.
fn earlier(shift: &CompletionShift, main: &Report, run: &Report) -> Expectation {
    let [in_main, here] = [main, run].map(|report| completed_s(report, &shift.vehicle));
    let passed = here.is_some_and(|time| in_main.unwrap_or(f64::INFINITY) - time >= shift.by_s - TIME_TOLERANCE_S);
    compared("earlier", shift, [in_main, here], passed)
}

fn compared(key: &str, shift: &CompletionShift, [in_main, here]: [Option<f64>; 2], passed: bool) -> Expectation {
    Expectation {
        what: format!("{key}.{}", shift.vehicle),
        want: json!({ "by_s": shift.by_s }),
        got: json!({ "main_s": in_main, "counterfactual_s": here }),
        passed,
        at: None,
    }
}

/// Whether exactly these expectations of the scenario fail in the counterfactual. Those that a flag has removed do not count.
fn breaks(names: &[String], scenario: &Scenario, run: &Report) -> Expectation {
    let stated = scenario.expect.names();
    let wanted: Vec<&String> = names.iter().filter(|name| stated.contains(*name)).collect();
    let judged = judge(&scenario.expect, run);
    let broken: Vec<&String> = judged.iter().filter(|one| !one.passed).map(|one| &one.what).collect();
    let passed = wanted.iter().all(|name| broken.contains(name)) && broken.iter().all(|name| wanted.contains(name));
    Expectation::new("breaks", json!(wanted), json!(broken), passed)
}
