//! Prices by the hour and heat pumps: against a closed form, SciPy, and sums by hand.

use interplay_building::calendar::{Calendar, RunDays};
use interplay_building::comfort::{Agenda, Setpoints, Targets};
use interplay_building::control::{DayRecord, Disturbance, optimum};
use interplay_building::day::{KeyFigures, ZoneFigures};
use interplay_building::discretise::{Discretisation, Model};
use interplay_building::energy::{CopPoint, HeatPump, Tariff};
use interplay_building::lifted::Lifted;
use interplay_building::network::{AMBIENT, Network, Wall, Zone};
use interplay_building::schedule::{DayChoice, Period, Timetable, ZoneSchedule};
use serde_json::Value as Json;

fn tariff(prices_per_kwh: Vec<f64>) -> Tariff {
    Tariff { prices_per_kwh, ..Tariff::default() }
}

fn curve(points: &[(f64, f64)]) -> Vec<CopPoint> {
    points.iter().map(|&(outdoor_c, cop)| CopPoint { outdoor_c, cop }).collect()
}

/// One zone that loses no heat, wanted warm at midnight only. With weights w(t) the cheapest heat is
/// `u(t) = λ / w(t)`, `λ = W b (r − T(0)) / (1 + W b² Σ 1/w)`, where `b = h/c` and W is W_e.
#[test]
fn heat_is_distributed_in_inverse_proportion_to_price_over_cop() {
    const STEPS: usize = 24;
    let network = Network::new(&[Zone { limit_kw: 100.0, ..Zone::named("store") }], &[]).expect("a zone");
    let model = Model::new(&network, Discretisation::Exact, 3600.0).expect("a model");
    let prices: Vec<f64> = (0..STEPS).map(|hour| 0.1 + 0.05 * (hour % 7) as f64).collect();
    let outdoor_c: Vec<f64> = (0..STEPS).map(|hour| -12.0 + hour as f64).collect();
    let heat_pump = HeatPump { heating: curve(&[(-10.0, 2.0), (10.0, 5.0)]), cooling: Vec::new() };
    let setpoints = Setpoints {
        occupied_c: vec![21.0],
        from_h: 24.0,
        to_h: 24.0,
        occupied_weight: 3.0,
        input_weight: 0.7,
        ..Setpoints::default()
    };
    let agenda = Agenda::new(setpoints, 1, 3600.0, STEPS).expect("setpoints");
    let agenda = agenda.supplied(Some(tariff(prices.clone())), Some(heat_pump));
    let today = agenda.of_day(0);
    let targets = today.under(&outdoor_c);
    let day = Disturbance { ambient_c: outdoor_c.clone(), gains_kw: vec![0.0; STEPS] };
    let found = optimum(&Lifted::new(&model, STEPS), &[15.0], &targets, &day, None).expect("solved");

    let mean = prices.iter().sum::<f64>() / STEPS as f64;
    // The line through both points, constant beyond them.
    let cop = |outdoor_c: f64| 3.5 + 0.15 * outdoor_c.clamp(-10.0, 10.0);
    let weight: Vec<f64> = (0..STEPS).map(|t| 0.7 * (prices[t] / mean) * 3.5 / cop(outdoor_c[t])).collect();
    let b = 3.6;
    let share = 3.0 * b * b * weight.iter().map(|w| 1.0 / w).sum::<f64>();
    let lambda = 3.0 * b * 6.0 / (1.0 + share);
    for (t, (heat_kw, weight)) in found.heat_kw.iter().zip(&weight).enumerate() {
        assert!((heat_kw - lambda / weight).abs() < 1e-6, "step {t}: {heat_kw} and not {}", lambda / weight);
    }
    let dearest = weight.iter().copied().fold(0.0, f64::max) / weight.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(dearest > 5.0, "the weights differ enough to tell: {dearest}");
}

fn floats(value: &Json) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|number| number.as_f64().expect("a number")).collect()
}

fn period(from_h: f64, to_h: f64, wanted_c: f64) -> Period {
    Period { from_h, to_h, wanted_c, band_k: None, people_kw: 0.0 }
}

fn schedule(zone: &str, periods: Vec<Period>) -> ZoneSchedule {
    ZoneSchedule { zones: vec![zone.to_owned()], days: vec![DayChoice::Everyday], other_c: None, base_kw: 0.0, periods }
}

/// The day of `tests/peers/priced_heat.py`: hours by zone, limits by direction, prices by hour, COP by outdoor temperature.
#[test]
fn the_cheapest_day_matches_scipys() {
    let wanted: Json = serde_json::from_str(include_str!("data/priced_heat.json")).expect("JSON");
    let zone = |name: &str, capacity_kj_per_k, heating_kw, cooling_kw| Zone {
        capacity_kj_per_k,
        heating_limit_kw: Some(heating_kw),
        cooling_limit_kw: Some(cooling_kw),
        ..Zone::named(name)
    };
    let zones = [zone("a", 6000.0, 2.2, 0.7), zone("b", 9000.0, 1.6, 0.4)];
    let walls = [Wall::new("a", AMBIENT, 12.0), Wall::new("b", AMBIENT, 15.0), Wall::new("a", "b", 20.0)];
    let network = Network::new(&zones, &walls).expect("a network");
    let model = Model::euler(&network, 3600.0).expect("stable");
    let schedules = [
        schedule("a", vec![period(8.0, 18.0, 21.0)]),
        schedule("b", vec![period(0.0, 7.0, 19.0), period(17.0, 24.0, 22.0)]),
    ];
    let timetable = Timetable::new(&schedules, network.names(), RunDays::default()).expect("hours");
    let hours = [(6, 0.16), (3, 0.48), (3, 0.3), (4, 0.1), (5, 0.5), (3, 0.2)];
    let prices: Vec<f64> = hours.iter().flat_map(|&(count, price)| vec![price; count]).collect();
    let cop = curve(&[(-5.0, 2.0), (3.0, 3.0), (10.0, 4.4)]);
    let heat_pump = HeatPump { heating: cop.clone(), cooling: cop };
    let setpoints = Setpoints { occupied_weight: 0.5, input_weight: 0.1, ..Setpoints::default() };
    let agenda = Agenda::new(setpoints, 2, 3600.0, 24).expect("setpoints").following(timetable);
    let today = agenda.supplied(Some(tariff(prices)), Some(heat_pump)).of_day(0);
    let day = Disturbance { ambient_c: floats(&wanted["outdoor_c"]), gains_kw: floats(&wanted["gains_kw"]) };
    let targets = today.under(&day.ambient_c);
    let found = optimum(&Lifted::new(&model, 24), &[20.0; 2], &targets, &day, None).expect("solved");
    for (i, (ours, scipy)) in found.heat_kw.iter().zip(floats(&wanted["heat_kw"])).enumerate() {
        assert!((ours - scipy).abs() < 1e-5, "input {i}: {ours} and not {scipy}");
    }
    let number = |key: &str| wanted[key].as_f64().expect("a number");
    assert!((found.cost / number("cost") - 1.0).abs() < 1e-8, "{} and not {}", found.cost, number("cost"));
    assert!(number("at_heating_limit") > 1.0 && number("at_cooling_limit") > 1.0, "both limits bind");
    let record = DayRecord {
        temperatures_c: found.temperatures_c,
        requested_kw: found.heat_kw.clone(),
        heat_kw: found.heat_kw,
        design: Default::default(),
    };
    let figures = KeyFigures::compute(&record, &targets, network.limits(), 3600.0);
    assert!((figures.electricity_kwh - number("electricity_kwh")).abs() < 1e-4);
    assert!((figures.energy_cost.expect("priced") - number("money")).abs() < 1e-4);
    let zones = ZoneFigures::of_all(&record, &targets, 3600.0);
    let sum = |of: fn(&ZoneFigures) -> f64| zones.iter().map(of).sum::<f64>();
    assert!((sum(|zone| zone.cost) - figures.cost).abs() < 1e-9, "zones share the cost");
    assert!((sum(|zone| zone.electricity_kwh) - figures.electricity_kwh).abs() < 1e-9);
    assert!((sum(|zone| zone.discomfort_k_h) / 2.0 - figures.discomfort_k_h).abs() < 1e-9, "a mean over zones");
    assert!((sum(|zone| zone.energy_cost.expect("priced")) - figures.energy_cost.expect("priced")).abs() < 1e-9);
}

#[test]
fn a_step_across_two_hours_costs_their_mean() {
    let tariff = tariff((0..48).map(f64::from).map(|hour| 1.0 + hour).collect());
    let steps = tariff.day_per_kwh(1, 2400.0, 36);
    // 0:00 to 0:40, 0:40 to 1:20, 1:20 to 2:00 of the second day.
    for (ours, expected) in steps.iter().zip([25.0, 25.5, 26.0, 27.0]) {
        assert!((ours - expected).abs() < 1e-12, "{ours} and not {expected}");
    }
    assert_eq!(tariff.day_per_kwh(2, 3600.0, 24), tariff.day_per_kwh(0, 3600.0, 24), "it begins again");
    assert_eq!(tariff.day_per_kwh(0, 900.0, 96)[..5], [1.0, 1.0, 1.0, 1.0, 2.0]);
}

/// The same price in every hour and one COP leave targets as they are, however large they are.
#[test]
fn a_constant_price_does_not_change_the_weights() {
    let plain = Agenda::new(Setpoints::default(), 2, 1800.0, 48).expect("setpoints");
    let heat_pump = HeatPump { heating: curve(&[(0.0, 3.2)]), cooling: curve(&[(0.0, 3.2)]) };
    let supplied = plain.clone().supplied(Some(tariff(vec![0.31])), Some(heat_pump));
    let (expected, found) = (plain.of_day(3), supplied.of_day(3));
    assert_eq!(found.under(&[30.0; 48]).input_weight, expected.input_weight);
    assert_eq!(found.tomorrow, None);
    let unweighed = Setpoints { weigh_energy: false, ..Setpoints::default() };
    let prices = (0..24).map(|hour| 0.1 + 0.01 * f64::from(hour)).collect();
    let heat_pump = HeatPump { heating: curve(&[(0.0, 2.0), (10.0, 4.0)]), cooling: Vec::new() };
    let unweighed =
        Agenda::new(unweighed, 2, 1800.0, 48).expect("setpoints").supplied(Some(tariff(prices)), Some(heat_pump));
    let today = unweighed.of_day(0);
    let under = today.under(&[5.0; 48]);
    assert_eq!(under.input_weight, expected.input_weight, "plans do not know prices");
    assert_eq!(under.supply.electric_kw(0, 3.0), 1.0, "the heat pump works all the same");
    assert_eq!(under.supply.money(47, 2.0), Some(2.0 * (0.1 + 0.01 * 23.0)));
}

/// Targets of a Friday know the Saturday after it, and a forecast of COP reaches both.
#[test]
fn a_horizon_beyond_midnight_knows_the_next_day() {
    let friday = Calendar { first_day: Some("2026-07-10".to_owned()), ..Calendar::default() };
    let names = ["office".to_owned()];
    let mut office = schedule("office", vec![period(8.0, 18.0, 21.0)]);
    office.days = vec![DayChoice::Workday];
    let timetable = Timetable::new(&[office], &names, friday.days(None).expect("a date")).expect("hours");
    let agenda = Agenda::new(Setpoints::default(), 1, 3600.0, 24).expect("setpoints").following(timetable);
    let occupied = |targets: &Targets| targets.occupied.iter().filter(|occupied| **occupied).count();
    let days: Vec<usize> = (0..4).map(|day| occupied(&agenda.of_day(day))).collect();
    assert_eq!(days, [11, 0, 0, 11], "Friday to Monday");
    let ahead = |day: usize| agenda.of_day(day).ahead(12, 24);
    assert_eq!(occupied(&ahead(0)), 6, "Friday afternoon, and no Saturday morning");
    assert_eq!(occupied(&ahead(2)), 5, "Monday morning");
}

/// Prices of markets may be negative: the plan stays convex, and the bill counts what is paid.
#[test]
fn a_negative_price_counts_little_in_plans_and_fully_in_the_bill() {
    let agenda = Agenda::new(Setpoints::default(), 1, 3600.0, 24).expect("setpoints");
    let today = agenda.supplied(Some(tariff(vec![-0.1, 0.5])), None).of_day(0);
    let expected = [0.05, 0.5 / 0.3, 0.05];
    let is_near = |(weight, expected): (&f64, &f64)| (weight - expected).abs() < 1e-12;
    assert!(today.input_weight.iter().zip(&expected).all(is_near), "at least a twentieth of the mean magnitude, 0.3");
    assert_eq!(today.supply.money(2, 3.0), Some(3.0 * -0.1));
}
