//! Converts long records to longer steps.
//!
//! The time of a fit is proportional to the number of rows. A long record has far more rows than its parameters need:
//! every k-th temperature is kept, and heat and weather are averaged over k rows, so that heat is conserved.

use crate::identify::telemetry::{Hold, SupplyAir, Telemetry};

/// Records of more rows have longer steps.
const MOST_ROWS: usize = 20_000;
/// The longest step \[s\]: an hour must be a multiple of it.
const HOUR_S: f64 = 3600.0;

/// Number of rows that become one.
pub(super) fn factor(telemetry: &Telemetry) -> usize {
    let rows = telemetry.rows();
    if rows <= MOST_ROWS {
        return 1;
    }
    let an_hour = libm::round(HOUR_S / telemetry.step_s) as usize;
    let divides =
        |factor: &usize| an_hour.is_multiple_of(*factor) && (an_hour as f64 * telemetry.step_s - HOUR_S).abs() < 1e-6;
    let allowed: Vec<usize> = (1..=an_hour).filter(divides).collect();
    let enough = allowed.iter().copied().find(|factor| rows / factor <= MOST_ROWS);
    enough.or(allowed.last().copied()).unwrap_or(1)
}

/// The telemetry with `factor` rows to a step, and the rows whose heat is unknown. Rows that do not fill a step at the end of a
/// segment are left out.
pub(super) fn decimated(telemetry: &Telemetry, unknown_heat: &[usize], factor: usize) -> (Telemetry, Vec<usize>) {
    let mut blocks = Vec::new();
    let mut segments = Vec::new();
    for segment in &telemetry.segments {
        let start = blocks.len();
        blocks.extend(segment.clone().step_by(factor).take_while(|row| row + factor <= segment.end));
        if blocks.len() > start {
            segments.push(start..blocks.len());
        }
    }
    let first = |values: &[f64]| -> Vec<f64> { blocks.iter().map(|&row| values[row]).collect() };
    let mean = |value: &dyn Fn(usize) -> f64| -> Vec<f64> {
        blocks.iter().map(|&row| (row..row + factor).map(value).sum::<f64>() / factor as f64).collect()
    };
    // A linear series has its mean over a row at the middle of the row.
    let held = |values: &[f64], hold: Hold| {
        mean(&|row| match hold {
            Hold::FirstOrder => 0.5 * (values[row] + values[(row + 1).min(values.len() - 1)]),
            Hold::ZeroOrder => values[row],
        })
    };
    let mut long = Telemetry {
        step_s: telemetry.step_s * factor as f64,
        time_s: first(&telemetry.time_s),
        segments,
        ..telemetry.clone()
    };
    for zone in &mut long.zones {
        zone.temperature_c = first(&zone.temperature_c);
        zone.power_kw = held(&zone.power_kw, zone.power_hold);
        zone.power_hold = Hold::ZeroOrder;
        for air in &mut zone.supply_air {
            let flow = mean(&|row| air.conductance_kw_per_k[row]);
            let carried = mean(&|row| air.conductance_kw_per_k[row] * air.temperature_c[row]);
            let plain = mean(&|row| air.temperature_c[row]);
            let of_flow =
                |((flow, carried), plain): ((&f64, &f64), &f64)| if *flow > 0.0 { carried / flow } else { *plain };
            let temperature_c = flow.iter().zip(&carried).zip(&plain).map(of_flow).collect();
            *air = SupplyAir { conductance_kw_per_k: flow, temperature_c };
        }
        zone.irradiance_kw_per_m2 = zone.irradiance_kw_per_m2.as_deref().map(|sun| held(sun, zone.irradiance_hold));
        zone.irradiance_hold = Hold::ZeroOrder;
    }
    for boundary in &mut long.boundaries {
        boundary.temperature_c = held(&boundary.temperature_c, boundary.hold);
        boundary.hold = Hold::ZeroOrder;
    }
    let is_unknown = |&index: &usize| {
        let row = blocks[index];
        let next = unknown_heat.partition_point(|&unknown| unknown < row);
        unknown_heat.get(next).is_some_and(|&unknown| unknown < row + factor)
    };
    let unknown = (0..blocks.len()).filter(is_unknown).collect();
    (long, unknown)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::synthetic_classroom::Classroom;

    #[test]
    fn decimation_conserves_heat_and_its_steps_divide_an_hour() {
        let telemetry = Classroom { days: 2, ..Classroom::default() }.simulate();
        assert_eq!(factor(&telemetry), 1, "it is short");
        let (long, unknown) = decimated(&telemetry, &[9], 4);
        assert_eq!((long.step_s, unknown), (3600.0, vec![2]));
        let heat = |telemetry: &Telemetry| telemetry.zones[0].power_kw.iter().sum::<f64>() * telemetry.step_s;
        let rows = long.rows() * 4;
        let short = telemetry.zones[0].power_kw[..rows].iter().sum::<f64>() * telemetry.step_s;
        assert!((heat(&long) / short - 1.0).abs() < 1e-12);
        assert_eq!(long.zones[0].temperature_c[7], telemetry.zones[0].temperature_c[28]);
    }
}
