//! Economic model predictive control: it pays little more than the optimum of the whole run, buys when it is cheap, keeps a priced
//! peak low, finds hidden walls, and learns what its forecast misses.

mod common;

use interplay_building::comfort::{Agenda, Setpoints, Targets};
use interplay_building::control::economic::EconomicSettings;
use interplay_building::control::{Control, ControlError, Controller, Disturbance, optimum};
use interplay_building::day::{Day, KeyFigures, RunHistory};
use interplay_building::discretise::Model;
use interplay_building::energy::Tariff;
use interplay_building::lifted::Lifted;
use interplay_building::network::{AMBIENT, Network, Wall, Zone};

const STEP_S: f64 = 1800.0;
const STEPS: usize = 48;

/// Two heated rooms with a heavy outer wall each.
fn building() -> Model {
    let zone = |name| Zone { heating_limit_kw: Some(4.0), cooling_limit_kw: Some(0.0), ..Zone::named(name) };
    let outer = |name: &str| Wall::new(name, AMBIENT, 12.0).with_capacity_kj_per_k(6000.0);
    let walls = [Wall::new("a", "b", 15.0), outer("a"), outer("b")];
    Model::exact(&Network::new(&["a", "b"].map(zone), &walls).expect("valid"), STEP_S).expect("valid")
}

fn agenda(tariff: Tariff) -> Agenda {
    let setpoints = Setpoints { occupied_c: vec![21.0], from_h: 6.0, to_h: 22.0, band_k: 1.0, ..Setpoints::default() };
    Agenda::new(setpoints, 2, STEP_S, STEPS).expect("valid").supplied(Some(tariff), None)
}

/// Cheap nights, and two dear hours in the evening.
fn tariff() -> Tariff {
    let prices_per_kwh = (0..24).map(|hour| {
        if hour < 6 {
            0.1
        } else if (17..19).contains(&hour) {
            0.6
        } else {
            0.3
        }
    });
    Tariff { prices_per_kwh: prices_per_kwh.collect(), ..Tariff::default() }
}

fn disturbance(more_kw: f64) -> Disturbance {
    let hour = |t: usize| t as f64 / STEPS as f64 * std::f64::consts::TAU;
    Disturbance {
        ambient_c: (0..STEPS).map(|t| 3.0 - 4.0 * hour(t).cos()).collect(),
        gains_kw: (0..STEPS)
            .flat_map(|t| if (16..40).contains(&t) { [0.2 + more_kw, 0.1] } else { [0.0, 0.0] })
            .collect(),
    }
}

struct Run {
    money: f64,
    discomfort_k_h: f64,
    /// Of each day.
    moneys: Vec<f64>,
    /// Heat of both rooms in the steps of the last day \[kW\].
    last_kw: Vec<f64>,
    history: RunHistory,
}

fn run(controller: &mut dyn Control, agenda: &Agenda, told: &Disturbance, actual: &Disturbance, days: usize) -> Run {
    let model = building();
    let mut nodes_c = vec![18.0; model.network().node_count()];
    let mut run = Run {
        money: 0.0,
        discomfort_k_h: 0.0,
        moneys: Vec::new(),
        last_kw: Vec::new(),
        history: RunHistory::default(),
    };
    for number in 0..days {
        let (targets, start_c) = (agenda.of_day(number), nodes_c.clone());
        let mut day = Day::new(nodes_c.clone(), told.clone(), actual.clone()).before(Some(told.clone()));
        day.plan(controller, &targets).expect("plans");
        for step in 0..STEPS {
            let heat = day.control(&model, controller, &targets, step, &nodes_c[..2]);
            day.balance(&model, step, &mut nodes_c, &heat);
        }
        day.learn(controller).expect("learns");
        assert!(day.record.design.fallback.is_none(), "{:?}", day.record.design.fallback);
        let figures = KeyFigures::compute(&day.record, &targets, model.network().limits(), STEP_S);
        run.moneys.push(figures.energy_cost.expect("a tariff"));
        run.money += figures.energy_cost.expect("a tariff");
        run.discomfort_k_h += figures.discomfort_k_h;
        run.last_kw = day.record.heat_kw.chunks_exact(2).map(|kw| kw.iter().sum()).collect();
        run.history.add(&targets, actual, [&start_c, &nodes_c]);
    }
    run
}

fn economic(settings: EconomicSettings) -> Box<dyn Control> {
    Controller::EconomicMpc(settings).controller(&building(), STEPS).expect("valid")
}

/// Accuracy without room for errors that do not occur.
fn exact() -> EconomicSettings {
    EconomicSettings { margin_k: Some(0.0), ..EconomicSettings::default() }
}

#[test]
fn with_an_exact_forecast_economic_mpc_pays_at_most_two_percent_more_than_the_optimum() {
    let told = disturbance(0.0);
    let run = run(&mut *economic(exact()), &agenda(tariff()), &told, &told, 4);
    let best = run.history.least_money(&building()).expect("solved");
    assert!(run.money >= best.energy_cost - 0.01, "{} and {}", run.money, best.energy_cost);
    assert!(run.money <= 1.02 * best.energy_cost, "{} and {}", run.money, best.energy_cost);
    // The cold start is the same for all controllers.
    assert!(run.discomfort_k_h <= best.discomfort_k_h + 0.1, "{} and {}", run.discomfort_k_h, best.discomfort_k_h);
}

/// Prices that are three times as high move the heat into the night before.
#[test]
fn the_economic_controller_buys_heat_when_it_is_cheap() {
    let told = disturbance(0.0);
    let night_kwh = |tariff: Tariff| {
        run(&mut *economic(exact()), &agenda(tariff), &told, &told, 3).last_kw[..12].iter().sum::<f64>()
    };
    let flat = Tariff { prices_per_kwh: vec![0.3], ..Tariff::default() };
    let (cheap, flat) = (night_kwh(tariff()), night_kwh(flat));
    assert!(cheap > 1.3 * flat, "{cheap} and {flat}");
}

#[test]
fn a_demand_charge_lowers_the_peak() {
    let told = disturbance(0.0);
    let peak_kw = |demand_per_kw: f64| {
        let tariff = Tariff { demand_per_kw, ..tariff() };
        run(&mut *economic(exact()), &agenda(tariff), &told, &told, 3).last_kw.iter().copied().fold(0.0, f64::max)
    };
    let (priced, free) = (peak_kw(3.0), peak_kw(0.0));
    assert!(priced < 0.9 * free, "{priced} and {free}");
}

/// Heat that is missing from the forecast every day is expected after some days: it costs no more discomfort and less money.
#[test]
fn a_repeated_forecast_error_is_learned() {
    let (told, actual) = (disturbance(0.0), disturbance(1.0));
    let last = |learn_forecast| {
        let settings = EconomicSettings { learn_forecast, ..exact() };
        let run = run(&mut *economic(settings), &agenda(tariff()), &told, &actual, 8);
        run.moneys[5..].iter().sum::<f64>()
    };
    let (learned, ignorant) = (last(true), last(false));
    assert!(learned < ignorant, "{learned} and {ignorant}");
}

/// No sequence of inputs with the same end costs less than the optimum of the run, not even the optimum of each day.
#[test]
fn consecutive_optima_of_days_cost_at_least_the_optimum_of_the_run() {
    let (model, actual) = (building(), disturbance(0.0));
    let agenda = agenda(tariff());
    let lifted = Lifted::new(&model, STEPS);
    let mut nodes_c = vec![18.0; model.network().node_count()];
    let (mut history, mut cost) = (RunHistory::default(), 0.0);
    for number in 0..3 {
        let (targets, start_c): (Targets, _) = (agenda.of_day(number), nodes_c.clone());
        let best = optimum(&lifted, &nodes_c, &targets, &actual, None).expect("solved");
        for (step, heat_kw) in best.heat_kw.chunks_exact(2).enumerate() {
            model.step(&mut nodes_c, heat_kw, actual.ambient_c[step], &actual.gains_kw[2 * step..2 * step + 2]);
        }
        cost += best.cost;
        history.add(&targets, &actual, [&start_c, &nodes_c]);
    }
    let least = history.least_cost(&model).expect("solved").cost;
    assert!(least <= cost * (1.0 + 1e-6), "{least} and {cost}");
    assert!(least > 0.5 * cost, "{least} and {cost}");
}

#[test]
fn settings_out_of_range_are_refused() {
    let wrong = EconomicSettings { horizon_h: 0.0, ..EconomicSettings::default() };
    let error = Controller::EconomicMpc(wrong).controller(&building(), STEPS).expect_err("refused");
    assert!(matches!(&error, ControlError::Setting(_)) && error.key().as_str() == "horizon_h", "{error}");
}
