//! The indicators of BOPTEST: against its own calculator, whose numbers `tests/peers/boptest/indicators.py` prints, and bad input.

use interplay_building::benchmark::{
    AirQuality, Carrier, Indicators, MeasuredRun, MeasurementError, PowerSignal, ThermalZone, Water,
};

const COUNT: usize = 4001;

/// The triangle of the script.
fn wave(period: usize, low: f64, high: f64) -> Vec<f64> {
    let half = period as f64 / 2.0;
    let value = |index: usize| {
        let phase = (index % period) as f64;
        low + (high - low) * (if phase < half { phase / half } else { (period as f64 - phase) / half })
    };
    (0..COUNT).map(value).collect()
}

fn switched(period: usize, until: usize, first: f64, then: f64) -> Vec<f64> {
    (0..COUNT).map(|index| if index % period < until { first } else { then }).collect()
}

fn held(value: f64) -> Vec<f64> {
    vec![value; COUNT]
}

fn electricity(price_per_kwh: &[f64], power_w: Vec<f64>) -> PowerSignal {
    let price_per_kwh = price_per_kwh.to_vec();
    PowerSignal { carrier: Carrier::Electricity, power_w, price_per_kwh, emission_kg_per_kwh: held(0.167) }
}

/// The signals of the script, with one of its price scenarios.
fn measured(electricity_per_kwh: &[f64]) -> MeasuredRun {
    let mut times_s = vec![1000.0];
    for index in 1..COUNT {
        times_s.push(times_s[index - 1] + if index % 2 == 1 { 30.0 } else { 50.0 });
    }
    let zones = vec![
        ThermalZone {
            temperature_c: wave(700, 291.0, 299.0),
            lower_c: switched(500, 200, 288.15, 294.15),
            upper_c: held(297.15),
        },
        ThermalZone {
            temperature_c: wave(1100, 293.0, 296.0),
            lower_c: held(294.15),
            upper_c: switched(500, 200, 295.15, 299.15),
        },
    ];
    let powers = vec![
        electricity(electricity_per_kwh, wave(130, 0.0, 4000.0)),
        electricity(electricity_per_kwh, wave(50, 10.0, 90.0)),
        PowerSignal {
            carrier: Carrier::Gas,
            power_w: wave(310, 0.0, 9000.0),
            price_per_kwh: held(0.07),
            emission_kg_per_kwh: held(0.2),
        },
        PowerSignal {
            carrier: Carrier::DistrictHeat,
            power_w: wave(410, 500.0, 7000.0),
            price_per_kwh: held(0.1),
            emission_kg_per_kwh: held(0.15),
        },
    ];
    MeasuredRun {
        times_s,
        area_m2: 192.0,
        zones,
        air: vec![AirQuality { concentration_ppm: wave(900, 400.0, 1200.0), limit_ppm: held(894.0) }],
        powers,
        water: vec![Water { flow_m3_per_s: wave(210, 0.0, 0.0002), price_per_m3: held(4.5) }],
    }
}

fn assert_near(name: &str, ours: f64, theirs: f64) {
    assert!((ours - theirs).abs() <= 1e-11 * theirs.abs(), "{name}: {ours} is not {theirs}");
}

/// BOPTEST 21433f81 with NumPy 1.26, SciPy 1.13 and pandas 2.1.
#[test]
fn indicators_match_boptests_own_calculator() {
    let scenarios = [
        (held(0.2535), 0.656_056_482_110_830_6),
        (switched(300, 100, 0.2383, 0.2666), 0.657_545_907_266_823_9),
        (wave(170, 0.1, 0.4), 0.655_023_774_433_441_7),
    ];
    for (price_per_kwh, cost_per_m2) in scenarios {
        let ours = Indicators::compute(&measured(&price_per_kwh)).expect("sound measurements");
        assert_near("cost", ours.cost_per_m2, cost_per_m2);
        assert_near("tdis", ours.tdis_k_h, 18.240_047_438_672_33);
        assert_near("idis", ours.idis_ppm_h, 2_488.515_123_456_79);
        assert_near("ener", ours.ener_kwh_per_m2, 2.402_113_433_686_515);
        assert_near("emis", ours.emis_kg_per_m2, 0.420_815_187_834_001_3);
        assert_near("pele", ours.pele_kw_per_m2.expect("electricity"), 0.019_416_943_473_193_473);
        assert_near("pgas", ours.pgas_kw_per_m2.expect("gas"), 0.045_184_200_879_765_4);
        assert_near("pdih", ours.pdih_kw_per_m2.expect("district heat"), 0.035_535_037_878_787_88);
    }
}

#[test]
fn a_carrier_without_a_signal_has_no_peak() {
    let mut electric = measured(&held(0.25));
    electric.powers.truncate(2);
    let indicators = Indicators::compute(&electric).expect("sound measurements");
    assert!(indicators.pele_kw_per_m2.is_some());
    assert_eq!((indicators.pgas_kw_per_m2, indicators.pdih_kw_per_m2), (None, None));
}

#[test]
fn the_time_ratio_is_the_mean_over_decisions() {
    assert_eq!(Indicators::computational_time_ratio(&[1.0, 2.0], 900.0), Some(1.5 / 900.0));
    assert_eq!(Indicators::computational_time_ratio(&[], 900.0), None);
}

#[test]
fn inconsistent_measurements_are_refused() {
    let refused = |change: fn(&mut MeasuredRun)| {
        let mut wrong = measured(&held(0.25));
        change(&mut wrong);
        Indicators::compute(&wrong).expect_err("refused")
    };
    assert_eq!(refused(|all| all.times_s.truncate(1)), MeasurementError::TooFewTimes { count: 1 });
    assert_eq!(refused(|all| all.area_m2 = 0.0), MeasurementError::Area { area_m2: 0.0 });
    assert!(matches!(refused(|all| all.area_m2 = f64::NAN), MeasurementError::Area { .. }));
    assert_eq!(
        refused(|all| all.times_s[2] = all.times_s[1]),
        MeasurementError::TimesDoNotRise { index: 2, time_s: 1030.0 }
    );
    assert!(matches!(refused(|all| all.times_s[7] = f64::NAN), MeasurementError::TimesDoNotRise { index: 7, .. }));
    let short = refused(|all| all.powers[1].power_w.truncate(5));
    assert_eq!(short, MeasurementError::Length { signal: "a power", count: 5, times: COUNT });
    let infinite = refused(|all| all.zones[0].lower_c[3] = f64::INFINITY);
    assert_eq!(infinite, MeasurementError::NotFinite { signal: "the lower end of a band", index: 3 });
}
