//! The smallest distances between footprints in a run.

use interplay_scenarios::MetricKind::Number;
use interplay_scenarios::{MetricComparison, MetricDeclaration, Scenario};

use crate::frame::PairGap;
use crate::measure::metric::{Measurement, Metric, ObservedMoment, ObservedTick};
use crate::measure::values::{Measured, MetricValue};

pub(super) const METRICS: &[&dyn Metric] = &[&EgoGap, &SmallestGap];

/// Of the ego to another.
#[derive(Clone, Copy, Debug)]
struct EgoGap;

/// Of any two vehicles, when it was reached first.
#[derive(Clone, Copy, Debug)]
struct SmallestGap;

#[derive(Clone, Debug)]
struct EgoGapSoFar(Option<f64>);

#[derive(Clone, Debug)]
struct SmallestGapSoFar(Option<PairGap>);

impl Metric for EgoGap {
    fn declaration(&self) -> MetricDeclaration {
        let doc = "Smallest distance of the ego's footprint to another; none without others";
        MetricDeclaration {
            report_key: Some("min_gap_m"),
            comparison_key: Some("gap_m"),
            ..MetricDeclaration::of_run("ego_gap_m", Number, doc).compared(MetricComparison::Quantiles)
        }
    }

    fn begin(&self, _: &Scenario, _: &ObservedMoment<'_>, _: usize) -> Box<dyn Measurement> {
        Box::new(EgoGapSoFar(None))
    }
}

impl Measurement for EgoGapSoFar {
    fn observe(&mut self, tick: &ObservedTick<'_>) {
        self.0 = self.0.into_iter().chain(tick.frame.smallest_gap_m).min_by(f64::total_cmp);
    }

    fn measured(&self) -> Measured {
        Measured::number(self.0)
    }

    fn fork(&self) -> Box<dyn Measurement> {
        Box::new(self.clone())
    }
}

impl Metric for SmallestGap {
    fn declaration(&self) -> MetricDeclaration {
        let doc = "Smallest distance of any two footprints; none without two vehicles";
        MetricDeclaration {
            report_key: Some("smallest_gap"),
            ..MetricDeclaration::of_run("smallest_gap_m", Number, doc)
        }
    }

    fn begin(&self, _: &Scenario, _: &ObservedMoment<'_>, _: usize) -> Box<dyn Measurement> {
        Box::new(SmallestGapSoFar(None))
    }
}

impl Measurement for SmallestGapSoFar {
    fn observe(&mut self, tick: &ObservedTick<'_>) {
        let smallest_m = self.0.as_ref().map_or(f64::INFINITY, |closest| closest.m);
        if let Some(closest) = tick.frame.closest.as_ref().filter(|closest| closest.m < smallest_m) {
            self.0 = Some(closest.clone());
        }
    }

    fn measured(&self) -> Measured {
        let measured = |gap: &PairGap| Measured {
            value: Some(MetricValue::Number(gap.m)),
            time_s: Some(gap.time_s),
            between: Some(gap.between.clone()),
            is_peak: false,
        };
        self.0.as_ref().map(measured).unwrap_or_default()
    }

    fn fork(&self) -> Box<dyn Measurement> {
        Box::new(self.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Frame;
    use crate::measure::metrics::tests::of_frames;

    #[test]
    fn the_first_of_the_smallest_gaps_counts() {
        let names = |pair: [&str; 2]| pair.map(str::to_owned);
        let seen = [(0.3, ["a", "b"], 0.0), (0.1, ["b", "c"], 0.13), (0.1, ["a", "c"], 0.2), (0.2, ["a", "b"], 0.3)];
        let frames = seen.map(|(m, between, time_s)| {
            let closest = Some(PairGap { m, between: names(between), time_s });
            Frame { closest, ..Frame::default() }
        });
        let wanted = Measured {
            value: Some(MetricValue::Number(0.1)),
            time_s: Some(0.13),
            between: Some(names(["b", "c"])),
            is_peak: false,
        };
        assert_eq!(of_frames(&SmallestGap, &frames), wanted);
        assert_eq!(of_frames(&EgoGap, &frames), Measured::default(), "no tick said anything of the ego");
    }
}
