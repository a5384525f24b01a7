//! The baselines: what they do by definition, and how they compare over days.

mod common;

use common::{distance, numbers};
use interplay_building::comfort::{Setpoints, Targets};
use interplay_building::control::concurrent::ConcurrentSettings;
use interplay_building::control::iterative::IterativeSettings;
use interplay_building::control::learning::LearningSettings;
use interplay_building::control::pid::PidSettings;
use interplay_building::control::thermostat::ThermostatSettings;
use interplay_building::control::uncertainty::UncertaintySettings;
use interplay_building::control::{
    Control, ControlError, Controller, DayAhead, DayRecord, Disturbance, Observation, optimum,
};
use interplay_building::day::{KeyFigures, Surroundings, run_day};
use interplay_building::discretise::Model;
use interplay_building::energy::EnergySupply;
use interplay_building::lifted::Lifted;
use interplay_building::network::{AMBIENT, Network, PowerLimits, Wall, Zone};
use interplay_building::occupancy::Occupancy;
use interplay_building::weather::{Climate, ErrorLevel, Forecast};

const STEP_S: f64 = 1800.0;
const STEPS: usize = 48;

fn testbed() -> Model {
    Model::exact(&Network::testbed(), STEP_S).expect("valid")
}

fn start(controller: Controller, model: &Model) -> Box<dyn Control> {
    controller.controller(model, STEPS).expect("valid settings")
}

fn targets(setpoints: &Setpoints, zones: usize) -> Targets {
    setpoints.targets(zones, STEP_S, STEPS).expect("valid")
}

/// Around the clock 22 °C in every zone.
fn always() -> Setpoints {
    Setpoints { occupied_c: vec![22.0], from_h: 0.0, to_h: 24.0, ..Setpoints::default() }
}

fn steady(ambient_c: f64, gains_kw: f64, zones: usize) -> Disturbance {
    Disturbance { ambient_c: vec![ambient_c; STEPS], gains_kw: vec![gains_kw; zones * STEPS] }
}

/// One zone with 31.25 K/kW to the air outside.
fn one_zone(limit_kw: f64) -> Model {
    let zone = Zone { limit_kw, ..Zone::named("a") };
    let network = Network::new(&[zone], &[Wall::new("a", AMBIENT, 31.25)]).expect("valid");
    Model::exact(&network, STEP_S).expect("valid")
}

/// What a controller asks for at given temperatures of a single zone, one a step.
fn answers(controller: Controller, targets: &Targets, temperatures_c: &[f64]) -> Vec<f64> {
    let mut controller = start(controller, &one_zone(2.0));
    let act = |(i, temperature_c): (usize, &f64)| {
        controller.act(&Observation { step: i + 1, temperatures_c: &[*temperature_c], targets })[0]
    };
    temperatures_c.iter().enumerate().map(act).collect()
}

#[test]
fn a_thermostat_starts_beyond_its_dead_band_and_stops_at_the_reference() {
    let thermostat = Controller::Thermostat(ThermostatSettings { dead_band_k: 0.5, power: 0.75 });
    let targets = targets(&always(), 1);
    let cooling = answers(thermostat.clone(), &targets, &[22.4, 22.6, 22.3, 22.0, 22.4, 21.6, 21.4, 21.9, 22.1]);
    assert_eq!(cooling, [0.0, -1.5, -1.5, 0.0, 0.0, 0.0, 1.5, 1.5, 0.0]);
    // Thrown from one side to the other, it turns round.
    assert_eq!(answers(thermostat.clone(), &targets, &[23.0, 21.0]), [-1.5, 1.5]);
    // Where the temperature is free it rests.
    let mut free = targets;
    free.error_weight.fill(0.0);
    assert_eq!(answers(thermostat, &free, &[30.0, 10.0]), [0.0, 0.0]);
}

#[test]
fn a_pid_controller_matches_its_formula() {
    let settings = PidSettings { proportional_kw_per_k: 0.2, integral_kw_per_k_h: 0.04, derivative_kw_h_per_k: 0.025 };
    let got = answers(Controller::Pid(settings), &targets(&always(), 1), &[21.0, 21.5, 22.25]);
    // Errors 1, 0.5, −0.25 K; 0.02 kW/K a step; −0.05 kW per kelvin of rise in a step.
    let want = [0.2 + 0.02, 0.1 + 0.02 * 1.5 - 0.05 * 0.5, -0.05 + 0.02 * 1.25 - 0.05 * 0.75];
    assert!(distance(&got, &want) < 1e-12, "{got:?}");
}

#[test]
fn integral_action_leaves_no_error_against_a_constant_disturbance() {
    let model = testbed();
    let (targets, day) = (targets(&always(), 4), steady(31.0, 0.35, 4));
    let after = |integral_kw_per_k_h: f64| {
        let settings = PidSettings { integral_kw_per_k_h, ..PidSettings::default() };
        let mut pid = start(Controller::Pid(settings), &model);
        let mut temperatures_c = vec![27.0; 4];
        for _ in 0..10 {
            run_day(&model, &mut temperatures_c, &mut *pid, &targets, &day, &day).expect("runs");
        }
        temperatures_c[0] - 22.0
    };
    assert!(after(0.04).abs() < 1e-6, "{}", after(0.04));
    // Without it the error is that of the steady state: k (T₀ − T) + w = k_p (T − r).
    let left_k = (0.35 + 9.0 / 31.25) / (0.2 + 1.0 / 31.25);
    assert!((after(0.0) - left_k).abs() < 1e-3, "{} {left_k}", after(0.0));
}

#[test]
fn a_pid_controller_does_not_wind_up() {
    // Half a day at a limit that is too low to hold the temperature; then it is cool outside.
    let model = one_zone(0.3);
    let targets = targets(&always(), 1);
    let mut day = steady(34.0, 0.4, 1);
    day.ambient_c[24..].fill(20.0);
    day.gains_kw[24..].fill(0.0);
    let mut pid = start(Controller::Pid(PidSettings::default()), &model);
    let record = run_day(&model, &mut [26.0], &mut *pid, &targets, &day, &day).expect("runs");
    assert!(record.heat_kw[..24].iter().all(|u| (u + 0.3).abs() < 1e-12), "at its limit all morning");
    let lowest_c = record.temperatures_c.iter().copied().fold(f64::MAX, f64::min);
    assert!(lowest_c > 21.0, "wound up, it would go on cooling until {lowest_c}");
    assert_eq!(record.heat_kw, record.requested_kw, "a PID controller knows its limits");
}

#[test]
fn learning_errors_follow_their_recursion() {
    // All days the same, no feedback, nothing at a limit: E_k+1 = (I − GL) E_k.
    let settings = LearningSettings {
        feedback: PidSettings { proportional_kw_per_k: 0.0, integral_kw_per_k_h: 0.0, derivative_kw_h_per_k: 0.0 },
        ..LearningSettings::default()
    };
    let network = Network::testbed();
    let model = Model::exact(&network, STEP_S).expect("valid");
    let lifted = Lifted::new(&model, STEPS);
    let mut learning = start(Controller::IterativeLearning(settings), &model);
    let (targets, day) = (targets(&always(), 4), steady(24.0, 0.1, 4));
    let mut errors_k: Vec<Vec<f64>> = Vec::new();
    for _ in 0..12 {
        let record = run_day(&model, &mut [22.5; 4], &mut *learning, &targets, &day, &day).expect("runs");
        errors_k.push(record.temperatures_c.iter().map(|t| 22.0 - t).collect());
    }
    for pair in errors_k.windows(2) {
        let correction: Vec<f64> =
            (0..pair[0].len()).map(|i| 0.15 * pair[0][i] - if i < 4 { 0.0 } else { 0.132 * pair[0][i - 4] }).collect();
        let predicted: Vec<f64> = pair[0].iter().zip(lifted.product(&correction)).map(|(e, gl)| e - gl).collect();
        assert!(distance(&predicted, &pair[1]) < 1e-10);
    }
    let norm = |e: &[f64]| e.iter().map(|e| e * e).sum::<f64>().sqrt();
    let largest = settings.convergence(&lifted).largest_singular_value;
    assert!(largest < 1.0, "{largest}");
    for pair in errors_k.windows(2) {
        assert!(norm(&pair[1]) <= largest * norm(&pair[0]) + 1e-12, "the singular value bounds every day");
    }
    assert!(norm(&errors_k[11]) < 0.05 * norm(&errors_k[0]));
}

#[test]
fn p_type_learning_errors_grow_before_they_converge() {
    let lifted = Lifted::new(&Model::euler(&Network::testbed(), STEP_S).expect("stable"), STEPS);
    let p_type =
        LearningSettings { proportional_kw_per_k: 0.2, derivative_kw_per_k: 0.0, ..LearningSettings::default() };
    let found = p_type.convergence(&lifted);
    // h₁ = 1.8 K/kW on the diagonal.
    assert!((found.spectral_radius - (1.0 - 0.2 * 1.8_f64)).abs() < 1e-12, "{found:?}");
    assert!(found.largest_singular_value > 1.5, "{found:?}");
    let pd_type = LearningSettings::default().convergence(&lifted);
    assert!(pd_type.largest_singular_value < 1.0, "{pd_type:?}");
}

/// Days of synthetic weather and occupancy.
struct World(Surroundings);

impl World {
    fn new(seed: u64, forecast: Forecast) -> Self {
        let weather = Climate::default().weather(seed, 8);
        let people = Occupancy::default().people(4, seed);
        Self(Surroundings::new(weather, (forecast, seed), people, testbed().network()))
    }

    /// Cost and regret of each of five days; the building goes on from where a day left it.
    fn run(&self, controller: Controller) -> Vec<(f64, f64)> {
        let model = testbed();
        let lifted = Lifted::new(&model, STEPS);
        let targets = targets(&Setpoints { other_c: Some(30.0), ..Setpoints::default() }, 4);
        let mut controller = start(controller, &model);
        let mut temperatures_c = vec![28.5; 4];
        (0..5)
            .map(|day| {
                let (forecast, actual) = (self.0.forecast(&model, STEPS, day), self.0.actual(&model, STEPS, day));
                let initial_c = temperatures_c.clone();
                let record = run_day(&model, &mut temperatures_c, &mut *controller, &targets, &forecast, &actual);
                let record = record.expect("runs");
                let figures = KeyFigures::compute(&record, &targets, model.network().limits(), STEP_S);
                assert_eq!(figures.input_violation_kw, 0.0);
                let best = optimum(&lifted, &initial_c, &targets, &actual, None).expect("solvable");
                (figures.cost, figures.cost - best.cost)
            })
            .collect()
    }
}

fn baselines() -> [Controller; 4] {
    [
        Controller::Thermostat(ThermostatSettings::default()),
        Controller::Pid(PidSettings::default()),
        Controller::IterativeLearning(LearningSettings { forecast: false, ..LearningSettings::default() }),
        Controller::IterativeLearning(LearningSettings::default()),
    ]
}

#[test]
fn only_the_clairvoyant_controller_has_no_regret() {
    for seed in 1..4 {
        let world = World::new(seed, Forecast::Uncertain { level: ErrorLevel::Medium });
        for controller in baselines() {
            for (cost, regret) in world.run(controller.clone()) {
                assert!(regret > 0.0, "{} {cost} {regret}", controller.kind());
            }
        }
        for (cost, regret) in world.run(Controller::Clairvoyant(Default::default())) {
            assert!(regret.abs() < 1e-6 * cost, "{regret}");
        }
    }
}

#[test]
fn learning_and_forecasts_lower_the_cost() {
    let mean = |seeds: std::ops::Range<u64>, forecast: Forecast, controller: Controller, day: usize| {
        let count = (seeds.end - seeds.start) as f64;
        seeds.map(|seed| World::new(seed, forecast).run(controller.clone())[day].1).sum::<f64>() / count
    };
    let learning =
        |forecast: bool| Controller::IterativeLearning(LearningSettings { forecast, ..LearningSettings::default() });
    let exact = Forecast::Exact;
    let first = mean(1..7, exact, learning(true), 0);
    let fifth = mean(1..7, exact, learning(true), 4);
    assert!(fifth < 0.5 * first, "learning lowers the regret: {first} to {fifth}");
    let blind = mean(1..7, exact, learning(false), 4);
    assert!(fifth < blind, "a forecast helps: {fifth} with, {blind} without");
}

#[test]
fn key_figures_match_their_definitions() {
    // Two zones, four steps of half an hour, the last two occupied.
    let targets = Targets {
        zones: 2,
        reference_c: vec![20.0; 8],
        error_weight: vec![0.0, 0.0, 0.0, 0.0, 2.0, 2.0, 2.0, 2.0],
        occupied: vec![false, false, false, false, true, true, true, true],
        input_weight: vec![3.0; 8],
        band_k: vec![0.5; 8],
        supply: EnergySupply::default(),
        tomorrow: None,
    };
    let record = DayRecord {
        temperatures_c: vec![10.0, 10.0, 10.0, 10.0, 21.0, 20.0, 20.0, 18.0],
        heat_kw: vec![1.0, -2.0, 0.0, 0.0, 0.5, 0.0, -1.0, -1.0],
        requested_kw: vec![1.0, -2.5, 0.0, 0.0, 0.5, 0.0, -1.0, -1.0],
        design: Default::default(),
    };
    let figures = KeyFigures::compute(&record, &targets, &PowerLimits::symmetric(&[2.0, 2.0]), STEP_S);
    assert_eq!(figures.cost, 2.0 * (1.0 + 4.0) + 3.0 * (1.0 + 4.0 + 0.25 + 1.0 + 1.0));
    assert!((figures.tracking_rmse_c - (5.0_f64 / 4.0).sqrt()).abs() < 1e-15);
    // Beyond the band: 0.5 K and 1.5 K, half an hour each, two zones.
    assert_eq!(figures.discomfort_k_h, 0.5);
    assert_eq!((figures.energy_kwh, figures.heating_kwh, figures.cooling_kwh), (2.75, 0.75, 2.0));
    assert_eq!((figures.peak_kw, figures.input_violation_kw), (3.0, 0.5));
    // A peak is a mean over a quarter of an hour.
    let fast = KeyFigures::compute(&record, &targets, &PowerLimits::symmetric(&[2.0, 2.0]), 300.0);
    assert!((fast.peak_kw - 2.0).abs() < 1e-15, "{}", fast.peak_kw);
}

#[test]
fn targets_apply_at_the_ends_of_steps() {
    let occupied_c = vec![24.0, 25.0, 26.0, 27.0];
    let targets =
        targets(&Setpoints { occupied_c, other_c: Some(30.0), other_weight: 0.25, ..Setpoints::default() }, 4);
    let at = |hour: f64| (2.0 * hour) as usize;
    assert_eq!(targets.reference_at(at(8.0)), [24.0, 25.0, 26.0, 27.0]);
    assert_eq!(targets.reference_at(at(7.5)), [30.0; 4]);
    assert_eq!(targets.reference_at(at(19.0)), [24.0, 25.0, 26.0, 27.0]);
    assert_eq!(targets.reference_at(at(19.5)), [30.0; 4]);
    assert_eq!((targets.weight_at(at(12.0)), targets.weight_at(0)), (&[1.0; 4][..], &[0.25; 4][..]));
    assert_eq!(targets.occupied.iter().filter(|&&occupied| occupied).count(), 23 * 4);
}

#[test]
fn wrong_settings_are_refused() {
    let model = testbed();
    let refused = |controller: Controller| match controller.controller(&model, STEPS) {
        Err(ControlError::Setting(error)) => error.key.to_string(),
        other => panic!("{other:?}"),
    };
    let thermostat = |dead_band_k, power| Controller::Thermostat(ThermostatSettings { dead_band_k, power });
    assert_eq!(refused(thermostat(-0.1, 1.0)), "dead_band_k");
    assert_eq!(refused(thermostat(0.1, 1.1)), "power");
    let pid = PidSettings { integral_kw_per_k_h: f64::NAN, ..PidSettings::default() };
    assert_eq!(refused(Controller::Pid(pid)), "integral_kw_per_k_h");
    let learning = LearningSettings { proportional_kw_per_k: -1.0, ..LearningSettings::default() };
    assert_eq!(refused(Controller::IterativeLearning(learning)), "proportional_kw_per_k");
    let feedback = PidSettings { proportional_kw_per_k: -1.0, ..PidSettings::default() };
    let learning = LearningSettings { feedback, ..LearningSettings::default() };
    assert_eq!(refused(Controller::IterativeLearning(learning)), "feedback.proportional_kw_per_k");
    let uncertainty = UncertaintySettings { zone_kw: -1.0, ..UncertaintySettings::default() };
    let iterative = IterativeSettings { uncertainty, ..IterativeSettings::default() };
    assert_eq!(refused(Controller::Iterative(iterative)), "uncertainty.zone_kw");
    let concurrent = ConcurrentSettings { uncertainty, ..ConcurrentSettings::default() };
    assert_eq!(refused(Controller::Concurrent(concurrent)), "uncertainty.zone_kw");

    for (key, wrong) in [
        ("occupied_c", Setpoints { occupied_c: vec![20.0; 3], ..Setpoints::default() }),
        ("occupied_c", Setpoints { occupied_c: vec![], ..Setpoints::default() }),
        ("occupied_c.1", Setpoints { occupied_c: vec![20.0, f64::NAN, 20.0, 20.0], ..Setpoints::default() }),
        ("other_c", Setpoints { other_c: Some(297.0), ..Setpoints::default() }),
        ("from_h", Setpoints { from_h: 25.0, ..Setpoints::default() }),
        ("to_h", Setpoints { to_h: 7.0, ..Setpoints::default() }),
        ("band_k", Setpoints { band_k: -1.0, ..Setpoints::default() }),
    ] {
        let error = wrong.targets(4, STEP_S, STEPS).expect_err("it makes no sense");
        assert_eq!(error.key().as_str(), key, "{error}");
    }
}

#[test]
fn a_day_of_another_building_is_refused_and_changes_nothing() {
    let model = testbed();
    let targets = targets(&always(), 4);
    let mut pid = start(Controller::Pid(PidSettings::default()), &model);
    let (right, wrong) = (steady(30.0, 0.1, 4), steady(30.0, 0.1, 3));
    let mut temperatures_c = vec![25.0; 4];
    let error = run_day(&model, &mut temperatures_c, &mut *pid, &targets, &right, &wrong).expect_err("refused");
    assert!(matches!(error, ControlError::Shape { what: "the heat gains", .. }), "{error}");
    assert_eq!(temperatures_c, [25.0; 4]);
    let mut clairvoyant = start(Controller::Clairvoyant(Default::default()), &model);
    let day_ahead =
        DayAhead { initial_c: &temperatures_c, targets: &targets, forecast: &right, outlook: None, actual: None };
    assert_eq!(clairvoyant.start_of_day(&day_ahead), Err(ControlError::NotClairvoyant));
}

#[test]
fn controllers_are_deserialised_by_their_kind() {
    let read = |text: &str| toml::from_str::<Controller>(text);
    let designs = [
        Controller::Clairvoyant(Default::default()),
        Controller::Iterative(Default::default()),
        Controller::Concurrent(Default::default()),
        Controller::Distributed(Default::default()),
        Controller::Centralised(Default::default()),
    ];
    for controller in baselines().into_iter().chain(designs) {
        let text = toml::to_string(&controller).expect("serialises");
        assert!(text.contains(&format!("kind = \"{}\"", controller.kind())));
        assert_eq!(read(&text).expect("its own text"), controller);
    }
    assert_eq!(read("kind = 'pid'").expect("defaults"), Controller::Pid(PidSettings::default()));
    assert!(read("kind = 'pid'\nproportional = 0.2").is_err(), "a key without its unit is unknown");
}

#[test]
fn baseline_inputs_stay_within_their_limits() {
    let model = testbed();
    let targets = targets(&Setpoints::default(), 4);
    for controller in baselines() {
        let mut controller = start(controller, &model);
        for (step, temperatures_c) in numbers(4 * STEPS, 20.0).chunks_exact(4).enumerate() {
            let asked = controller.act(&Observation { step, temperatures_c, targets: &targets });
            assert!(asked.iter().all(|u| u.abs() <= 2.0), "{asked:?}");
        }
    }
}
