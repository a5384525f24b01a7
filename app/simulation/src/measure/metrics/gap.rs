//! The smallest distances between footprints in a run.

use interplay_scenarios::MetricKind::Number;
use interplay_scenarios::{MetricComparison, MetricDeclaration};

use crate::measure::metric::Metric;
use crate::measure::values::Measured;
use crate::measure::vehicle_metric::LeastOfRun;

const EGO_GAP_DOC: &str = "Smallest distance of the ego's footprint to another; none without others";
const SMALLEST_GAP_DOC: &str = "Smallest distance of any two footprints; none without two vehicles";

pub(super) const METRICS: &[&dyn Metric] = &[&EGO_GAP, &SMALLEST_GAP];

const EGO_GAP: LeastOfRun = LeastOfRun {
    declaration: MetricDeclaration {
        report_key: Some("min_gap_m"),
        comparison_key: Some("gap_m"),
        ..MetricDeclaration::of_run("ego_gap_m", Number, EGO_GAP_DOC).compared(MetricComparison::Quantiles)
    },
    quantity: |tick, _| tick.frame.smallest_gap_m.map(|gap_m| Measured::number(Some(gap_m))),
};

const SMALLEST_GAP: LeastOfRun = LeastOfRun {
    declaration: MetricDeclaration {
        report_key: Some("smallest_gap"),
        ..MetricDeclaration::of_run("smallest_gap_m", Number, SMALLEST_GAP_DOC)
    },
    quantity: |tick, _| {
        tick.frame.closest.as_ref().map(|gap| Measured::between(gap.m, gap.between.clone(), gap.time_s))
    },
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::metrics::tests::of_frames;
    use crate::state::frame::{Frame, PairGap};

    #[test]
    fn the_earliest_of_equal_smallest_gaps_is_reported() {
        let names = |pair: [&str; 2]| pair.map(str::to_owned);
        let seen = [(0.3, ["a", "b"], 0.0), (0.1, ["b", "c"], 0.13), (0.1, ["a", "c"], 0.2), (0.2, ["a", "b"], 0.3)];
        let frames = seen.map(|(m, between, time_s)| {
            let closest = Some(PairGap { m, between: names(between), time_s });
            Frame { closest, ..Frame::default() }
        });
        let wanted = Measured::between(0.1, names(["b", "c"]), 0.13);
        assert_eq!(of_frames(&SMALLEST_GAP, &frames), wanted);
        assert_eq!(of_frames(&EGO_GAP, &frames), Measured::default(), "no tick has a gap of the ego");
    }
}
