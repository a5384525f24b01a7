//! Wanted temperatures of zones, and the colours of deviations from them.

use interplay_scenarios::Scenario;
use interplay_simulation::frame::ZoneFrame;

use crate::palette::{COLOUR_RANGE_K, Colour, temperature_colour};

/// The mean wanted temperature of each zone while it is occupied \[°C\].
pub fn usual_wanted_c(scenario: &Scenario, names: &[String]) -> Vec<f64> {
    let mean_c = |values: &mut dyn Iterator<Item = f64>| {
        let (sum, count) = values.fold((0.0, 0), |(sum, count), value| (sum + value, count + 1));
        (count > 0).then(|| sum / f64::from(count))
    };
    let setpoints = scenario.setpoints.clone().unwrap_or_default();
    let of_all = |zone: usize| setpoints.occupied_c.get(zone.min(setpoints.occupied_c.len().saturating_sub(1)));
    let of_zone = |(zone, name): (usize, &String)| {
        let own = scenario.schedules.iter().filter(|schedule| schedule.zones.contains(name));
        let scheduled = mean_c(&mut own.flat_map(|schedule| &schedule.periods).map(|period| period.wanted_c));
        scheduled.or_else(|| of_all(zone).copied()).unwrap_or_default()
    };
    names.iter().enumerate().map(of_zone).collect()
}

/// The mean over the zones of their usual wanted temperature \[°C\].
pub fn middle_c(usual_c: &[f64]) -> f64 {
    usual_c.iter().sum::<f64>() / usual_c.len().max(1) as f64
}

/// The colour of a zone by its deviation from the wanted temperature, or from its usual one while none is wanted.
pub fn zone_colour(zone: &ZoneFrame, temperature_c: f64, usual_c: f64) -> Colour {
    deviation_colour(temperature_c - zone.reference_c.unwrap_or(usual_c))
}

/// The colour of a deviation from the wanted temperature \[K\].
pub fn deviation_colour(deviation_k: f64) -> Colour {
    temperature_colour(deviation_k / COLOUR_RANGE_K)
}

/// A number with one decimal, and with a minus sign instead of a hyphen.
pub fn one_decimal(value: f64) -> String {
    let rounded = (10.0 * value).round() / 10.0;
    let sign = if rounded < 0.0 { "−" } else { "" };
    format!("{sign}{:.1}", rounded.abs())
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::load;

    use super::*;

    #[test]
    fn the_usual_temperature_is_the_mean_of_the_schedule() {
        let names = ["office", "flat"].map(str::to_owned);
        let scenario = load("building/office-and-flat", &[]).expect("embedded");
        let usual_c = usual_wanted_c(&scenario, &names);
        assert_eq!(usual_c[0], 21.0);
        assert!((20.0..=21.0).contains(&usual_c[1]), "{usual_c:?}");
    }

    #[test]
    fn room_colours_are_relative_to_the_wanted_or_usual_temperature() {
        let zone = |reference_c| ZoneFrame {
            temperature_c: 21.0,
            next_c: 21.0,
            reference_c,
            band_k: None,
            requested_kw: 0.0,
            heat_kw: 0.0,
            gains_kw: 0.0,
            sun_kw: 0.0,
            electric_kw: 0.0,
        };
        assert_eq!(zone_colour(&zone(Some(21.0)), 21.0, 25.0), deviation_colour(0.0));
        assert_eq!(zone_colour(&zone(None), 21.0, 25.0), deviation_colour(-4.0));
    }

    #[test]
    fn negative_numbers_have_a_minus_sign() {
        assert_eq!([-1.84, -0.04, 0.0, 3.06].map(one_decimal), ["−1.8", "0.0", "0.0", "3.1"]);
    }
}
