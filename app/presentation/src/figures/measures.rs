//! The measures of runs, as tables.

use interplay_building::day::ZoneFigures;
use interplay_simulation::report::{BuildingReport, CounterfactualReport, Report, ZoneOutcome};

use super::recorded_run::RecordedRun;
use crate::plot::TextTable;

/// The measures of several runs, side by side, for comparison with the dissertation.
pub fn side_by_side(recorded_runs: &[&RecordedRun]) -> Vec<TextTable> {
    let mut tables = Vec::new();
    let drives: Vec<&&RecordedRun> =
        recorded_runs.iter().filter(|recorded| !recorded.report.vehicles.is_empty()).collect();
    if !drives.is_empty() {
        tables.push(driving(&drives));
    }
    let houses = recorded_runs.iter().filter_map(|recorded| Some((*recorded, recorded.report.building.as_ref()?)));
    let houses: Vec<(&RecordedRun, &BuildingReport)> = houses.collect();
    if !houses.is_empty() {
        tables.push(building(&houses));
    }
    tables
}

fn driving(recorded_runs: &[&&RecordedRun]) -> TextTable {
    let header = [
        "run",
        "reaches its goal [s]",
        "order at the end",
        "speed of the ego [m/s]",
        "smallest gap [m]",
        "collisions",
        "plans that failed",
        "expectations",
    ];
    let row = |recorded: &&&RecordedRun| {
        let report = &recorded.report;
        let ego = report.vehicles.get(recorded.scenario.ego_index());
        let completed = report
            .vehicles
            .iter()
            .filter_map(|vehicle| vehicle.completed_s.map(|time_s| format!("{} {time_s:.1}", vehicle.name)));
        let completed: Vec<String> = completed.collect();
        let failed: usize = report.vehicles.iter().map(|vehicle| vehicle.plans.failed).sum();
        [
            label(recorded),
            if completed.is_empty() { "none".to_owned() } else { completed.join(", ") },
            report.order_of_driven().join(", "),
            ego.map_or_else(String::new, |ego| {
                ego.speed_range_mps().map(|speed_mps| format!("{speed_mps:.2}")).join(" to ")
            }),
            report.min_gap_m().map_or_else(|| "–".to_owned(), |gap_m| format!("{gap_m:.3}")),
            report.collisions.len().to_string(),
            failed.to_string(),
            expectations(report, recorded.changed()),
        ]
    };
    TextTable::new("Measured", header, recorded_runs.iter().map(row).collect())
}

fn building(houses: &[(&RecordedRun, &BuildingReport)]) -> TextTable {
    let header = [
        "run",
        "cost J, day by day",
        "error, last day [K]",
        "discomfort, last day [K·h]",
        "above the cheapest, last day",
        "energy, last day [kWh]",
        "over the limit, any day [kW]",
        "design of a day, slowest [ms]",
        "expectations",
    ];
    let row = |(recorded, report): &(&RecordedRun, &BuildingReport)| {
        let days = &report.iterations;
        let costs: Vec<String> = days.iter().map(|day| format!("{:.1}", day.figures.cost)).collect();
        let last = |value: fn(&interplay_simulation::day::DayFigures) -> f64| {
            days.last().map_or_else(String::new, |day| format!("{:.3}", value(day)))
        };
        let most =
            |value: fn(&interplay_simulation::day::DayFigures) -> f64| days.iter().map(value).fold(0.0, f64::max);
        [
            label(recorded),
            costs.join(", "),
            last(|day| day.figures.tracking_rmse_c),
            last(|day| day.figures.discomfort_k_h),
            days.last().and_then(|day| day.regret).map_or_else(|| "–".to_owned(), |regret| format!("{regret:.1}")),
            last(|day| day.figures.energy_kwh),
            format!("{:.3}", most(|day| day.figures.input_violation_kw)),
            format!("{:.1}", 1e3 * most(|day| day.design_s)),
            expectations(&recorded.report, recorded.changed()),
        ]
    };
    TextTable::new("Measured", header, houses.iter().map(row).collect())
}

/// Every zone of a building, over all days.
pub fn zones(report: &BuildingReport) -> TextTable {
    let currency = report.currency.as_deref().unwrap_or("no tariff");
    let money = format!("cost of electricity [{currency}]");
    let header = [
        "zone",
        "cost J",
        "error, last day [K]",
        "discomfort [K·h]",
        "heat [kWh]",
        "electricity [kWh]",
        money.as_str(),
    ];
    let row = |zone: &ZoneOutcome| {
        let total = |value: fn(&ZoneFigures) -> f64| zone.iterations.iter().map(value).sum::<f64>();
        let last_k = zone.iterations.last().map_or(0.0, |day| day.tracking_rmse_c);
        let money: Option<f64> = zone.iterations.iter().map(|day| day.energy_cost).sum();
        [
            zone.zone.clone(),
            format!("{:.1}", total(|day| day.cost)),
            format!("{last_k:.3}"),
            format!("{:.3}", total(|day| day.discomfort_k_h)),
            format!("{:.2}", total(|day| day.energy_kwh)),
            format!("{:.2}", total(|day| day.electricity_kwh)),
            money.map_or_else(|| "–".to_owned(), |money| format!("{money:.2}")),
        ]
    };
    TextTable::new("Zones, all days together", header, report.zone_figures.iter().map(row).collect())
}

fn label(recorded: &RecordedRun) -> String {
    if recorded.label.is_empty() { recorded.report.scenario.clone() } else { recorded.label.clone() }
}

/// How many expectations held; those of a scenario that was changed on purpose do not count.
fn expectations(report: &Report, changed: bool) -> String {
    let held = report.expectations.iter().filter(|expectation| expectation.passed).count();
    let count = report.expectations.len();
    match (count, changed) {
        (0, _) => "none stated".to_owned(),
        (_, true) => format!("{held} of the original's {count} hold"),
        (_, false) => format!("{held} of {count} held"),
    }
}

/// Every expectation of a run, with the expected and the measured value.
pub fn expected(report: &Report) -> TextTable {
    let row = |expectation: &interplay_simulation::report::Expectation| {
        let [wanted, measured] = expectation.words();
        let outcome = if expectation.passed { "held" } else { "FAILED" };
        [expectation.what.clone(), wanted, measured, outcome.to_owned()]
    };
    let rows = report.expectations.iter().map(row).collect();
    TextTable::new("Expectations", ["what", "wanted", "measured", ""], rows)
}

/// The counterfactuals of a run with their outcomes.
pub fn counterfactuals(report: &Report) -> TextTable {
    let row = |one: &CounterfactualReport| {
        let run = &one.run;
        let completed = run.vehicles.iter().filter_map(|vehicle| Some((&vehicle.name, vehicle.completed_s?)));
        let completed: Vec<String> = completed.map(|(name, time_s)| format!("{name} {time_s:.1}")).collect();
        let failed: Vec<String> = one.failed().map(ToString::to_string).collect();
        [
            one.name.clone(),
            one.order.join(", "),
            completed.join(", "),
            run.min_gap_m().map_or_else(|| "–".to_owned(), |gap_m| format!("{gap_m:.3}")),
            if one.passed { "held".to_owned() } else { format!("FAILED: {}", failed.join("; ")) },
        ]
    };
    let header = ["counterfactual", "order at the end", "reaches its goal [s]", "smallest gap [m]", ""];
    TextTable::new("Counterfactuals", header, report.counterfactuals.iter().map(row).collect())
}
