//! Economic model predictive control does not depend on how large limits are stated, on the currency or on the step.

use interplay_building::comfort::{Agenda, Setpoints};
use interplay_building::control::Controller;
use interplay_building::control::Disturbance;
use interplay_building::control::economic::EconomicSettings;
use interplay_building::day::{Day, KeyFigures, RunHistory, RunOptimum};
use interplay_building::discretise::Model;
use interplay_building::energy::Tariff;
use interplay_building::network::{AMBIENT, Network, Wall, Zone};
use interplay_common::random::Random;

const DAYS: usize = 3;

/// A random house, its heater limited to `limit_kw`, its prices multiplied by `factor`, in steps of `step_s`.
struct House {
    seed: u64,
    limit_kw: f64,
    factor: f64,
    step_s: f64,
}

struct Run {
    money: f64,
    discomfort_k_h: f64,
    optimum: RunOptimum,
}

impl House {
    fn steps(&self) -> usize {
        (86_400.0 / self.step_s) as usize
    }

    fn model(&self) -> Model {
        let mut random = Random::new(self.seed, 72);
        let mut zone = |name: &'static str| Zone {
            capacity_kj_per_k: random.uniform(1500.0, 5000.0),
            heating_limit_kw: Some(self.limit_kw),
            cooling_limit_kw: Some(0.0),
            ..Zone::named(name)
        };
        let zones = ["a", "b"].map(&mut zone);
        let mut outer = |name: &str| {
            let wall = Wall::new(name, AMBIENT, random.uniform(8.0, 25.0));
            wall.with_capacity_kj_per_k(random.uniform(5000.0, 20_000.0))
        };
        let walls = [outer("a"), outer("b"), Wall::new("a", "b", 12.0)];
        Model::exact(&Network::new(&zones, &walls).expect("valid"), self.step_s).expect("valid")
    }

    fn tariff(&self) -> Tariff {
        let mut random = Random::new(self.seed, 73);
        let price = |hour: usize| 0.2 + 0.1 * libm::sin(hour as f64 * std::f64::consts::TAU / 12.0);
        let prices_per_kwh = (0..24).map(|hour| self.factor * (price(hour) + random.uniform(-0.05, 0.05))).collect();
        Tariff { prices_per_kwh, ..Tariff::default() }
    }

    fn disturbance(&self) -> Disturbance {
        let hour = |step: usize| step as f64 / self.steps() as f64 * std::f64::consts::TAU;
        Disturbance {
            ambient_c: (0..self.steps()).map(|step| 2.0 - 4.0 * libm::cos(hour(step))).collect(),
            gains_kw: vec![0.1; 2 * self.steps()],
        }
    }

    fn run(&self) -> Run {
        let (model, told) = (self.model(), self.disturbance());
        let setpoints =
            Setpoints { occupied_c: vec![21.0], from_h: 6.0, to_h: 22.0, band_k: 1.0, ..Setpoints::default() };
        let agenda =
            Agenda::new(setpoints, 2, self.step_s, self.steps()).expect("valid").supplied(Some(self.tariff()), None);
        let controller = Controller::EconomicMpc(EconomicSettings::default());
        let mut controller = controller.controller(&model, self.steps()).expect("valid");
        let mut nodes_c = vec![20.0; model.network().node_count()];
        let (mut money, mut discomfort_k_h, mut history) = (0.0, 0.0, RunHistory::default());
        for number in 0..DAYS {
            let (targets, start_c) = (agenda.of_day(number), nodes_c.clone());
            let mut day = Day::new(nodes_c.clone(), told.clone(), told.clone()).before(Some(told.clone()));
            day.plan(&mut *controller, &targets).expect("plans");
            for step in 0..self.steps() {
                let heat = day.control(&model, &mut *controller, &targets, step, &nodes_c[..2]);
                day.balance(&model, step, &mut nodes_c, &heat);
            }
            day.learn(&mut *controller).expect("learns");
            assert!(day.record.design.fallback.is_none(), "{:?}", day.record.design.fallback);
            let real = targets.under(&told.ambient_c);
            let figures = KeyFigures::compute(&day.record, &real, model.network().limits(), self.step_s);
            money += figures.energy_cost.expect("a tariff");
            discomfort_k_h += figures.discomfort_k_h;
            history.add(&real, &told, [&start_c, &nodes_c]);
        }
        Run { money, discomfort_k_h, optimum: history.least_money(&model).expect("solved") }
    }
}

const USUAL: House = House { seed: 0, limit_kw: 20.0, factor: 1.0, step_s: 1800.0 };

fn near(one: f64, other: f64, share: f64) -> bool {
    (one / other - 1.0).abs() < share
}

/// More power may buy all heat in the cheapest step, so a larger limit may save a little; it never costs, and beyond what any plan uses
/// it changes nothing.
#[test]
fn a_limit_that_is_stated_large_costs_nothing() {
    for seed in 0..2 {
        let [usual, large, huge] = [20.0, 1e3, 1e6].map(|limit_kw| House { seed, limit_kw, ..USUAL }.run());
        assert!(large.money <= 1.01 * usual.money, "{seed}: {} and {}", large.money, usual.money);
        assert!(near(huge.money, large.money, 0.01), "{seed}: {} and {}", huge.money, large.money);
        let (one, other) = (huge.optimum.energy_cost, large.optimum.energy_cost);
        assert!(near(one, other, 0.01), "{seed}: optimum {one} and {other}");
        assert!(huge.money <= 1.02 * huge.optimum.energy_cost, "{seed}: {} above {one}", huge.money);
    }
}

#[test]
fn another_currency_changes_no_plan() {
    let usual = USUAL.run();
    for factor in [1e-3, 1e3] {
        let other = House { factor, ..USUAL }.run();
        assert!(near(other.money, factor * usual.money, 0.01), "{factor}: {} and {}", other.money, usual.money);
        assert!((other.discomfort_k_h - usual.discomfort_k_h).abs() < 0.02, "{factor}: {}", other.discomfort_k_h);
    }
}

#[test]
fn with_an_exact_forecast_the_cost_is_near_the_optimum_with_the_same_end() {
    for seed in 0..4 {
        let run = House { seed, ..USUAL }.run();
        let best = &run.optimum;
        assert!(run.money <= 1.02 * best.energy_cost, "{seed}: {} and {}", run.money, best.energy_cost);
        assert!(run.discomfort_k_h <= best.discomfort_k_h + 0.05, "{seed}: {}", run.discomfort_k_h);
    }
}

#[test]
fn prices_with_a_mean_of_zero_or_below_are_planned_for() {
    for offset in [-0.2, -0.4] {
        let mut tariff = USUAL.tariff();
        tariff.prices_per_kwh.iter_mut().for_each(|price| *price += offset);
        tariff.check().expect("prices may be negative");
        assert!(tariff.day_per_kwh(0, 1800.0, 48).iter().all(|price| price.is_finite()));
    }
    Tariff { prices_per_kwh: vec![0.0], ..Tariff::default() }.check().expect("electricity may be free");
}

/// A room that is never occupied is kept from freezing, and a negative price does not heat it without limit.
#[test]
fn empty_rooms_keep_within_their_limits() {
    let house = House { limit_kw: 50.0, ..USUAL };
    let model = house.model();
    let setpoints = Setpoints { from_h: 12.0, to_h: 12.5, band_k: 1.0, occupied_c: vec![21.0], ..Setpoints::default() };
    let extreme = |ambient_c: f64, price: f64| {
        let tariff = Tariff { prices_per_kwh: vec![price], ..Tariff::default() };
        let agenda = Agenda::new(setpoints.clone(), 2, 1800.0, 48).expect("valid").supplied(Some(tariff), None);
        let told = Disturbance { ambient_c: vec![ambient_c; 48], gains_kw: vec![0.0; 96] };
        let controller = Controller::EconomicMpc(EconomicSettings::default());
        let mut controller = controller.controller(&model, 48).expect("valid");
        let mut nodes_c = vec![15.0; model.network().node_count()];
        let mut seen = (f64::INFINITY, f64::NEG_INFINITY);
        for number in 0..2 {
            let targets = agenda.of_day(number);
            let mut day = Day::new(nodes_c.clone(), told.clone(), told.clone()).before(Some(told.clone()));
            day.plan(&mut *controller, &targets).expect("plans");
            for step in 0..48 {
                let heat = day.control(&model, &mut *controller, &targets, step, &nodes_c[..2]);
                day.balance(&model, step, &mut nodes_c, &heat);
                let rooms = &nodes_c[..2];
                seen = rooms.iter().fold(seen, |(low, high), room| (low.min(*room), high.max(*room)));
            }
            day.learn(&mut *controller).expect("learns");
        }
        seen
    };
    assert!(extreme(-30.0, 0.3).0 > 4.5, "{:?}", extreme(-30.0, 0.3));
    assert!(extreme(20.0, -0.1).1 < 41.0, "{:?}", extreme(20.0, -0.1));
}
