//! A metric: the shortest time headway of each vehicle, in every report, row and comparison.

// shown from here
use interplay_scenarios::{Better, MetricComparison, MetricDeclaration, MetricKind, Registry, RegistryError, Scenario};
use interplay_simulation::measure::{
    Measured, Measurement, Metric, ObservedMoment, ObservedTick, RegisterMetrics, VehicleMoment,
};

/// The shortest time headway of a vehicle: the time in which it gets to where the rear bumper of the vehicle ahead in its lane is.
#[derive(Debug)]
struct Headway;

/// The shortest one so far.
#[derive(Clone, Copy, Debug)]
struct ShortestHeadway {
    /// The index of the vehicle that is measured.
    vehicle: usize,
    shortest_s: Option<f64>,
}

impl Metric for Headway {
    fn declaration(&self) -> MetricDeclaration {
        let doc = "Shortest time headway to a vehicle ahead in its lane; none without a vehicle ahead";
        MetricDeclaration::of_vehicle("time_headway_s", MetricKind::Number, doc)
            .compared(MetricComparison::Quantiles)
            .better(Better::Higher)
    }

    fn begin(&self, _: &Scenario, _: &ObservedMoment<'_>, vehicle: usize) -> Box<dyn Measurement> {
        Box::new(ShortestHeadway { vehicle, shortest_s: None })
    }
}

impl Measurement for ShortestHeadway {
    fn observe(&mut self, tick: &ObservedTick<'_>) {
        let own = tick.end.of(self.vehicle);
        let headway_s = |other: VehicleMoment<'_>| {
            let beside_m = other.state.y_m - own.state.y_m;
            let bumpers_m = own.vehicle.body.front_m + other.vehicle.body.rear_m;
            let gap_m = other.state.x_m - own.state.x_m - bumpers_m;
            (beside_m.abs() < own.vehicle.body.width_m && gap_m > 0.0).then(|| gap_m / own.state.speed_mps)
        };
        let all_s = (0..tick.end.states.len()).filter_map(|other| headway_s(tick.end.of(other)));
        self.shortest_s = self.shortest_s.into_iter().chain(all_s).min_by(f64::total_cmp);
    }

    fn measured(&self) -> Measured {
        Measured::number(self.shortest_s)
    }

    fn fork(&self) -> Box<dyn Measurement> {
        Box::new(*self)
    }
}

/// All that Interplay has, and this metric. `interplay::main_with(&registry()?)` is a command that has it, too.
fn registry() -> Result<Registry, RegistryError> {
    Registry::default().with_metric(Headway)
}
// shown until here

use std::error::Error;

use interplay_scenarios::{Override, Scenario as Loaded};
use interplay_simulation::report::Report;
use interplay_simulation::run::run;
use interplay_sweep::compare::{GroupBy, compare};
use interplay_sweep::{RowTable, Shard, SweepOptions, TableColumn, sweep};
use serde_json::{Value as Json, json};

use crate::command::scratch;

fn driven(expected: &str) -> Result<(Loaded, Report), Box<dyn Error>> {
    let changes = [Override::Set(format!("expect.metric=[{expected}]"))];
    let scenario = registry()?.load("lane-change/both-tough", &changes)?;
    let report = run("headway", &scenario, Vec::new())?;
    Ok((scenario, report))
}

#[test]
fn a_user_defined_metric_is_reported_and_may_be_expected() -> Result<(), Box<dyn Error>> {
    let at_least = "{ name = 'time_headway_s', vehicle = 'ego', at_least = 0.01 }";
    let (_, report) = driven(&format!("{at_least}, {{ name = 'time_headway_s', at_least = 100.0 }}"))?;
    let json = serde_json::to_value(&report)?;
    let headway_s = json["vehicles"][0]["time_headway_s"].as_f64().ok_or("the ego ends behind others")?;
    assert!((0.01..2.0).contains(&headway_s), "{headway_s}");
    let of_metrics: Vec<&Json> = json["expectations"].as_array().ok_or("a list")?.iter().collect();
    let judged = |what: &str| of_metrics.iter().find(|one| one["what"] == what).copied().ok_or(what.to_owned());
    let ego = judged("metric.time_headway_s.ego.at_least")?;
    assert_eq!((&ego["got"], &ego["passed"]), (&json!(headway_s), &json!(true)));
    let all = judged("metric.time_headway_s.at_least")?;
    assert_eq!((&all["passed"], all["got"]["vehicle"].is_string()), (&json!(false), true), "{all}");
    Ok(())
}

#[test]
fn a_user_defined_metric_has_a_column_and_is_compared() -> Result<(), Box<dyn Error>> {
    let folder = scratch("own-metric");
    let text = "scenario = ['lane-change/both-tough']\nplanner = ['idm', 'conservative']\nset = { 'expect' = {} }\n";
    let registry = registry()?;
    let plan = registry.sweep_plan_from_text("headways.toml", text, &folder)?;
    let (folder, nothing) = (folder.join("out"), || ());
    let options = SweepOptions {
        folder: &folder,
        shard: Shard::WHOLE,
        keep: None,
        trajectories: false,
        checked: &nothing,
        begin: &|_, _| (),
        advance: &nothing,
    };
    let table = RowTable::read(&sweep(&plan, &options)?.table, &["time_headway_s".to_owned()])?;
    let Some(TableColumn::Numbers(column)) = table.column("time_headway_s") else { return Err("no column".into()) };
    let mut sorted: Vec<f64> = column.iter().copied().flatten().collect();
    sorted.sort_by(f64::total_cmp);
    assert_eq!(sorted.len(), 2, "both end behind another vehicle");
    let compared = compare(&folder, Some("idm"), GroupBy::Family, registry.metrics())?;
    let planners = &compared.groups[0].planners;
    let mut least: Vec<f64> =
        planners.iter().filter_map(|one| Some(one.figures.quantiles("time_headway_s")?.least)).collect();
    least.sort_by(f64::total_cmp);
    assert_eq!(least, sorted, "a run each");
    let versus = planners.iter().find_map(|one| one.versus_baseline.as_ref()).ok_or("there are two planners")?;
    let split = versus.metrics.get("time_headway_s");
    assert_eq!(split.wins + split.losses, usize::from(sorted[0] < sorted[1]));
    Ok(())
}

#[test]
fn unknown_and_duplicate_metrics_are_refused() -> Result<(), Box<dyn Error>> {
    let refused = driven("{ name = 'time_hedway_s', at_least = 0.1 }").map(|_| ()).expect_err("a wrong name");
    let refused = format!("{refused:?}");
    assert!(refused.contains("there is no metric") && refused.contains("time_headway_s"), "{refused}");
    let wrong = driven("{ name = 'time_headway_s', is = true }").map(|_| ()).expect_err("a number");
    let wrong = format!("{wrong:?}");
    assert!(wrong.contains("state `at_most` or `at_least`"), "{wrong}");
    let wrong = driven("{ name = 'ego_gap_m', vehicle = 'ego', at_least = 0.0 }").map(|_| ()).expect_err("of the run");
    assert!(format!("{wrong:?}").contains("leave `vehicle` out"), "{wrong:?}");
    let twice = registry()?.with_metric(Headway).map(|_| ()).expect_err("it is there");
    assert_eq!(twice, RegistryError::MetricTaken("time_headway_s".to_owned()));
    Ok(())
}

#[test]
fn the_page_of_metrics_is_what_they_declare() -> Result<(), Box<dyn Error>> {
    let page = interplay_simulation::measure::metric_table(Registry::standard().metrics());
    let path = crate::architecture::root().join("docs/reference/metrics.md");
    if std::env::var_os("INTERPLAY_BLESS").is_some() {
        std::fs::write(&path, &page)?;
    }
    let written = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(written == page, "docs/reference/metrics.md is out of date: renew it with INTERPLAY_BLESS=1");
    let own = interplay_simulation::measure::metric_table(registry()?.metrics());
    assert!(own.contains("| `time_headway_s` | vehicles |  | s | quantiles, higher is better |"), "{own}");
    Ok(())
}
