//! Comfort bounds that another program (such as BOPTEST) states for all times of a run.

use super::targets::{Setpoints, Targets};

/// A zone counts as occupied while its bounds are at most this much wider than the narrowest ones of the run \[K\].
const WIDTH_TOLERANCE_K: f64 = 0.05;
const DAY_S: f64 = 86_400.0;

/// The lowest and the highest comfortable temperature of each zone over a run.
///
/// A zone counts as occupied where its bounds are closest together: there it has a wanted temperature and a band that reaches down
/// to the lower bound. At other times its temperature is free, or the setting `other_c` of the setpoints states it.
#[derive(Clone, Debug, PartialEq)]
pub struct ComfortBounds {
    /// How long each value holds \[s\].
    pub interval_s: f64,
    /// The bounds of each zone; a zone without any is free at all times.
    pub zones: Vec<Option<ZoneBounds>>,
    /// The wanted temperature, above the lower bound \[K\]; none for the middle of the bounds.
    pub wanted_above_lower_k: Option<f64>,
}

/// The bounds of a zone from the first midnight on.
#[derive(Clone, Debug, PartialEq)]
pub struct ZoneBounds {
    /// Lowest temperatures \[°C\]; at least one. The last holds on.
    pub lower_c: Vec<f64>,
    /// Highest temperatures \[°C\]; at least one. The last holds on.
    pub upper_c: Vec<f64>,
}

impl ComfortBounds {
    /// Writes the bounds of a day into its targets, zone after zone; zones beyond those of the bounds keep what they have.
    pub(super) fn write(&self, targets: &mut Targets, day: usize, step_s: f64, setpoints: &Setpoints) {
        let count = targets.zones;
        for (zone, bounds) in self.zones.iter().enumerate().take(count) {
            let narrowest_k = bounds.as_ref().map_or(0.0, ZoneBounds::narrowest_k);
            for step in 0..targets.steps() {
                let i = step * count + zone;
                targets.occupied[i] = false;
                targets.error_weight[i] = 0.0;
                let Some(bounds) = bounds else { continue };
                let from_s = day as f64 * DAY_S + step as f64 * step_s;
                let (lower_c, upper_c) = bounds.at_end(from_s, from_s + step_s, self.interval_s);
                if upper_c - lower_c <= narrowest_k + WIDTH_TOLERANCE_K {
                    let half_k = 0.5 * (upper_c - lower_c);
                    let above_k = self.wanted_above_lower_k.unwrap_or(half_k).min(half_k);
                    targets.occupied[i] = true;
                    targets.error_weight[i] = setpoints.occupied_weight;
                    targets.reference_c[i] = lower_c + above_k;
                    targets.band_k[i] = above_k.max(0.0);
                } else if let Some(other_c) = setpoints.other_c {
                    targets.error_weight[i] = setpoints.other_weight;
                    targets.reference_c[i] = other_c;
                }
            }
        }
    }
}

impl ZoneBounds {
    fn narrowest_k(&self) -> f64 {
        self.upper_c.iter().zip(&self.lower_c).map(|(upper, lower)| upper - lower).fold(f64::INFINITY, f64::min)
    }

    /// The bounds at the end of a step: the narrower ones of those just before and at that time.
    fn at_end(&self, from_s: f64, to_s: f64, interval_s: f64) -> (f64, f64) {
        let value = |values: &[f64], time_s: f64| {
            let place = (time_s / interval_s + 1e-9).floor().max(0.0) as usize;
            values.get(place).or(values.last()).copied().unwrap_or_default()
        };
        // The last value that begins before the end of the step.
        let before_s = from_s.max(to_s - interval_s);
        let lower_c = value(&self.lower_c, before_s).max(value(&self.lower_c, to_s));
        let upper_c = value(&self.upper_c, before_s).min(value(&self.upper_c, to_s));
        (lower_c, upper_c)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_zone_is_occupied_where_its_bounds_are_closest() {
        let setpoints = Setpoints { other_c: Some(19.0), other_weight: 0.5, ..Setpoints::default() };
        let mut targets = setpoints.targets(2, 3600.0, 24).expect("targets");
        let lower_c = (0..24).map(|hour| if (7..20).contains(&hour) { 15.0 } else { 21.0 }).collect();
        let upper_c = (0..24).map(|hour| if (7..20).contains(&hour) { 30.0 } else { 24.0 }).collect();
        let zones = vec![Some(ZoneBounds { lower_c, upper_c }), None];
        let mut bounds = ComfortBounds { interval_s: 3600.0, zones, wanted_above_lower_k: None };
        bounds.write(&mut targets, 0, 3600.0, &setpoints);
        let zone = |step: usize| (targets.occupied[2 * step], targets.reference_c[2 * step], targets.band_k[2 * step]);
        // The temperature at 7 o'clock ends the night, and that at 20 o'clock begins the evening.
        assert_eq!([zone(6), zone(19)], [(true, 22.5, 1.5); 2]);
        assert_eq!((zone(7).0, zone(7).1, targets.error_weight[14]), (false, 19.0, 0.5));
        assert!((0..24).all(|step| !targets.occupied[2 * step + 1] && targets.error_weight[2 * step + 1] == 0.0));
        bounds.wanted_above_lower_k = Some(0.6);
        bounds.write(&mut targets, 3, 3600.0, &setpoints);
        assert_eq!((targets.reference_c[0], targets.band_k[0]), (21.6, 0.6), "the last values hold on");
    }
}
