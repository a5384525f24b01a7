//! Remarks on heat that is probably in another unit than the mapping says: nothing else in a record would reveal it.

use super::telemetry::{MeasuredZone, Telemetry};

/// The most heat of a usual zone: that of a large hall \[kW\].
const MOST_KW: f64 = 200.0;
/// The least heat whose effect a sensor sees: that of a small lamp \[kW\].
const LEAST_KW: f64 = 0.005;

/// A remark on each zone whose measured heat is unusually large or small throughout.
pub(super) fn remarks(telemetry: &Telemetry) -> Vec<String> {
    telemetry.zones.iter().filter_map(remark).collect()
}

fn remark(zone: &MeasuredZone) -> Option<String> {
    let largest_kw =
        zone.power_kw.iter().filter(|power| power.is_finite()).fold(0.0_f64, |most, power| most.max(power.abs()));
    let advice = "is the `unit` in the mapping right? Capacities and conductances follow it";
    match largest_kw {
        much if much > MOST_KW => Some(format!("{}: its heat reaches {much:.0} kW; {advice}", zone.name)),
        little if little > 0.0 && little < LEAST_KW => {
            Some(format!("{}: its heat is never above {:.2} W; {advice}", zone.name, 1000.0 * little))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::synthetic_classroom::Classroom;

    #[test]
    fn heat_in_watts_instead_of_kilowatts_is_remarked_upon() {
        let telemetry = Classroom { days: 1, ..Classroom::default() }.simulate();
        assert!(remarks(&telemetry).is_empty());
        for (factor, word) in [(1000.0, "reaches"), (0.0001, "never above")] {
            let mut wrong = telemetry.clone();
            wrong.zones[0].power_kw.iter_mut().for_each(|power| *power *= factor);
            let said = remarks(&wrong);
            assert!(said.len() == 1 && said[0].contains(word), "{said:?}");
        }
    }
}
