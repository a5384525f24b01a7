//! The synthetic climate, forecasts and occupancy: in range, repeatable, and wrong as they should be.

use interplay_building::occupancy::{Deviation, Occupancy};
use interplay_building::weather::{Climate, ErrorLevel, Forecast};

const DAY_S: f64 = 86_400.0;
const STEP_S: f64 = 1800.0;
const STEPS: usize = 48;

fn mean(x: &[f64]) -> f64 {
    x.iter().sum::<f64>() / x.len() as f64
}

fn rms(x: impl Iterator<Item = f64>) -> f64 {
    let squares: Vec<f64> = x.map(|x| x * x).collect();
    mean(&squares).sqrt()
}

#[test]
fn the_synthetic_climate_resembles_singapore() {
    let weather = Climate::default().weather(7, 60);
    let days: Vec<Vec<f64>> = (0..60).map(|day| weather.ambient_steps_c(day as f64 * DAY_S, STEP_S, STEPS)).collect();
    let all: Vec<f64> = days.concat();
    assert!((28.0..29.0).contains(&mean(&all)), "{}", mean(&all));
    let (low, high) = all.iter().fold((f64::MAX, f64::MIN), |(l, h), &t| (l.min(t), h.max(t)));
    assert!(low > 23.0 && low < 26.0 && high > 31.5 && high < 34.0, "{low} {high}");
    // Afternoons are warmer than mornings before dawn, and days differ.
    let at = |hour: f64| mean(&days.iter().map(|day| day[(2.0 * hour) as usize]).collect::<Vec<f64>>());
    assert!(at(13.5) - at(5.5) > 4.0);
    assert!(rms(days[3].iter().zip(&days[4]).map(|(a, b)| a - b)) > 0.2);
    // The sun shines by day.
    let sun = weather.sun_steps_w_per_m2(0.0, 3600.0, 24);
    assert!(sun[2] == 0.0 && sun[12] > 300.0 && sun[22] == 0.0);
}

#[test]
fn days_depend_on_the_seed_alone() {
    let climate = Climate::default();
    let (short, long) = (climate.weather(3, 2), climate.weather(3, 9));
    assert_eq!(short.ambient_steps_c(0.0, STEP_S, 2 * STEPS - 2), long.ambient_steps_c(0.0, STEP_S, 2 * STEPS - 2));
    assert_ne!(climate.weather(4, 2), short);
}

#[test]
fn exact_and_persistence_forecasts_match_their_definitions() {
    let weather = Climate::default().weather(1, 5);
    let actual = |day: f64| weather.ambient_steps_c(day * DAY_S, STEP_S, STEPS);
    assert_eq!(Forecast::Exact.ambient_steps_c(&weather, 9, 2, STEP_S, STEPS), actual(2.0));
    assert_eq!(Forecast::Persistence.ambient_steps_c(&weather, 9, 2, STEP_S, STEPS), actual(1.0));
    assert_eq!(Forecast::Persistence.ambient_steps_c(&weather, 9, 0, STEP_S, STEPS), actual(-1.0));
}

#[test]
fn forecast_errors_have_boptest_s_moments() {
    const DAYS: usize = 4000;
    for level in [ErrorLevel::Low, ErrorLevel::Medium, ErrorLevel::High] {
        let model = level.model();
        let errors: Vec<Vec<f64>> = (0..DAYS).map(|day| model.errors_k(5, day, 24)).collect();
        let at = |hour: usize| errors.iter().map(|day| day[hour]).collect::<Vec<f64>>();
        let (mut expected_mean, mut expected_variance) = (model.first_mean_k, model.first_deviation_k.powi(2));
        for hour in 0..=24 {
            let values = at(hour);
            let standard_error = (expected_variance / DAYS as f64).sqrt();
            assert!((mean(&values) - expected_mean).abs() < 4.0 * standard_error, "{level:?} {hour}");
            let variance = mean(&values.iter().map(|e| (e - mean(&values)).powi(2)).collect::<Vec<f64>>());
            assert!((variance / expected_variance - 1.0).abs() < 4.0 * (2.0 / DAYS as f64).sqrt(), "{level:?} {hour}");
            expected_mean = model.correlation * expected_mean + model.drift_k;
            expected_variance = model.correlation.powi(2) * expected_variance + model.deviation_k.powi(2);
        }
    }
}

#[test]
fn an_uncertain_forecast_is_the_truth_plus_an_error() {
    let weather = Climate::default().weather(1, 3);
    let forecast = Forecast::Uncertain { level: ErrorLevel::Medium };
    let errors = ErrorLevel::Medium.model().errors_k(9, 1, 24);
    let forecast_c = forecast.ambient_steps_c(&weather, 9, 1, 3600.0, 24);
    for (hour, (forecast_c, actual_c)) in forecast_c.iter().zip(weather.ambient_steps_c(DAY_S, 3600.0, 24)).enumerate()
    {
        assert!((forecast_c - actual_c - 0.5 * (errors[hour] + errors[hour + 1])).abs() < 1e-12);
    }
    assert_eq!(forecast_c, forecast.ambient_steps_c(&weather, 9, 1, 3600.0, 24), "repeatable");
    assert_ne!(errors, ErrorLevel::Medium.model().errors_k(9, 2, 24), "each day has its own");
}

#[test]
fn occupancy_is_scheduled_in_working_hours() {
    let people = Occupancy::default().people(4, 1);
    let scheduled_kw = people.scheduled_kw(0, STEP_S, STEPS);
    let zone = |t: usize, i: usize| scheduled_kw[4 * t + i];
    for i in 0..4 {
        assert!((0.3..0.45).contains(&people.peaks_kw[i]));
        assert_eq!((zone(0, i), zone(47, i)), (0.02, 0.02), "only the base at night");
        assert!((zone(20, i) - 0.02 - people.peaks_kw[i]).abs() < 1e-3, "full at ten");
        assert!(zone(24, i) < 0.75 * zone(20, i), "lunch");
        assert!(
            (zone(15, i) - 0.02 - 0.25 * people.peaks_kw[i]).abs() < 0.01,
            "people are coming at a quarter to eight"
        );
    }
}

#[test]
fn real_occupancy_deviates_by_the_stated_amounts() {
    let mut deviations_kw = Vec::new();
    for seed in 0..20 {
        let people = Occupancy::default().people(4, seed);
        for bias in &people.biases {
            assert!((0.1..0.25).contains(&(bias - 1.0).abs()), "{bias}");
        }
        let scheduled_kw = people.scheduled_kw(0, STEP_S, STEPS);
        let actual_kw: Vec<Vec<f64>> = (0..5).map(|day| people.actual_kw(day, STEP_S, STEPS)).collect();
        assert_ne!(actual_kw[0], actual_kw[1]);
        assert!(actual_kw.concat().iter().all(|&kw| kw >= 0.02));
        // Steps 16 to 37 are working hours.
        deviations_kw.push(rms(actual_kw.iter().flat_map(|day| {
            day.iter().zip(&scheduled_kw).map(|(a, s)| a - s).skip(16 * 4).take(22 * 4).collect::<Vec<f64>>()
        })));
    }
    assert!(deviations_kw.iter().all(|rms| (0.05..0.15).contains(rms)), "{deviations_kw:?}");
    assert!((0.06..0.11).contains(&mean(&deviations_kw)), "{deviations_kw:?}");
}

#[test]
fn without_deviation_occupancy_equals_the_schedule() {
    let people = Occupancy { deviation: Deviation::NONE, ..Occupancy::default() }.people(3, 1);
    assert_eq!(people.actual_kw(4, STEP_S, STEPS), people.scheduled_kw(0, STEP_S, STEPS));
}
