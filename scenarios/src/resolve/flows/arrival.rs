//! The arrival times of the vehicles of a flow.

use interplay_common::random::{Random, hash_of};

use crate::format::flow::{FlowConfig, Headways};
use crate::model::traffic::lane_reference::LaneReference;

/// The largest deviation of a speed from its mean, in standard deviations.
const MOST_DEVIATIONS: f64 = 2.0;
const HOUR_S: f64 = 3600.0;

/// A vehicle of a flow.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Arrival<'a> {
    /// Its number, from 1.
    pub number: usize,
    /// When it comes, if there is room \[s\].
    pub enters_s: f64,
    /// The index of its lane among those of the flow.
    pub lane: usize,
    /// The lane to which it drives, if the flow states some.
    pub to: Option<&'a LaneReference>,
    /// The index of its sort, if there are several.
    pub sort: Option<usize>,
    /// The speed with which it comes, which is also its desired speed \[m/s\].
    pub speed_mps: f64,
}

pub(super) fn expected(flow: &FlowConfig, duration_s: f64) -> f64 {
    pieces(flow, duration_s).iter().map(|[from_s, to_s, per_s]| (to_s - from_s) * per_s).sum()
}

/// The intervals with a constant rate of vehicles: from, to, vehicles per second.
fn pieces(flow: &FlowConfig, duration_s: f64) -> Vec<[f64; 3]> {
    let end_s = flow.ends_s.unwrap_or(duration_s).min(duration_s);
    let rates = match flow.vehicles_per_h {
        Some(rate) => vec![[0.0, rate]],
        None => flow.rates.clone(),
    };
    let until_s = |index: usize| rates.get(index + 1).map_or(f64::INFINITY, |next| next[0]);
    let piece = |(index, [from_s, per_h]): (usize, &[f64; 2])| {
        let (from_s, to_s) = (from_s.max(flow.begins_s), until_s(index).min(end_s));
        (to_s > from_s).then_some([from_s, to_s, per_h / HOUR_S])
    };
    rates.iter().enumerate().filter_map(piece).collect()
}

/// The vehicles of a flow in a run. The first of them are the same in a longer run.
pub(super) fn draw(flow: &FlowConfig, seed: u64, duration_s: f64) -> Vec<Arrival<'_>> {
    let pieces = pieces(flow, duration_s);
    let mut random = Random::new(seed, hash_of(&flow.name));
    let mut arrivals: Vec<Arrival<'_>> = Vec::new();
    let (mut count, mut last_s) = (0.0, f64::NEG_INFINITY);
    loop {
        let number = arrivals.len() + 1;
        // In units of expected vehicles the mean headway is 1.
        let drawn = -libm::log(1.0 - random.uniform(0.0, 1.0));
        count = match flow.headways {
            Headways::Exponential => count + drawn,
            Headways::Even => number as f64 - 0.5,
        };
        let Some(wanted_s) = when(&pieces, count) else { return arrivals };
        let enters_s = wanted_s.max(last_s + flow.headway_min_s);
        if pieces.last().is_none_or(|last| enters_s >= last[1]) {
            return arrivals;
        }
        last_s = enters_s;
        let lane = (random.uniform(0.0, flow.from.len() as f64) as usize).min(flow.from.len() - 1);
        let to = share_at(random.uniform(0.0, 1.0), flow.to.iter().map(|goal| goal.share));
        let sort = share_at(random.uniform(0.0, 1.0), flow.mix.iter().map(|sort| sort.share));
        let deviations = random.normal(0.0, 1.0).clamp(-MOST_DEVIATIONS, MOST_DEVIATIONS);
        let mean_mps = sort.and_then(|sort| flow.mix[sort].speed_mps).unwrap_or(flow.speed_mps);
        arrivals.push(Arrival {
            number,
            // No vehicle of a flow is on the road before the run begins.
            enters_s: enters_s.max(f64::MIN_POSITIVE),
            lane,
            to: to.map(|index| &flow.to[index].lane),
            sort,
            speed_mps: (mean_mps + deviations * flow.speed_sd_mps).max(0.1 * mean_mps),
        });
    }
}

/// When `count` vehicles are expected to have come; `None` if that is after the end.
fn when(pieces: &[[f64; 3]], count: f64) -> Option<f64> {
    let mut before = 0.0;
    for [from_s, to_s, per_s] in pieces {
        let within = (to_s - from_s) * per_s;
        if before + within > count {
            return Some(from_s + (count - before) / per_s);
        }
        before += within;
    }
    None
}

/// The index of the share in which a number from 0 to 1 lies; `None` without shares.
fn share_at(number: f64, shares: impl Iterator<Item = f64> + Clone) -> Option<usize> {
    let sum: f64 = shares.clone().sum();
    let mut left = number * sum;
    let mut last = None;
    for (index, share) in shares.enumerate().filter(|(_, share)| *share > 0.0) {
        last = Some(index);
        if left < share {
            break;
        }
        left -= share;
    }
    last
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::flow::FlowGoal;

    fn flow() -> FlowConfig {
        FlowConfig {
            name: "west".to_owned(),
            vehicles_per_h: Some(1200.0),
            from: vec![LaneReference::from(0), LaneReference::from(1)],
            speed_mps: 20.0,
            speed_sd_mps: 2.0,
            to: [("a", 0.8), ("b", 0.2)].map(|(lane, share)| FlowGoal { lane: lane.into(), share }).to_vec(),
            ..FlowConfig::default()
        }
    }

    #[test]
    fn rates_lanes_routes_and_speeds_are_as_stated() {
        let flow = flow();
        let duration_s = 36_000.0;
        let drawn = draw(&flow, 1, duration_s);
        // 12,000 expected, with a standard deviation of 110.
        assert!((drawn.len() as f64 - expected(&flow, duration_s)).abs() < 400.0, "{}", drawn.len());
        let share =
            |of: &dyn Fn(&Arrival) -> bool| drawn.iter().filter(|one| of(one)).count() as f64 / drawn.len() as f64;
        assert!((share(&|one| one.lane == 0) - 0.5).abs() < 0.02);
        assert!((share(&|one| one.to == Some(&"a".into())) - 0.8).abs() < 0.02);
        let mean_mps = drawn.iter().map(|one| one.speed_mps).sum::<f64>() / drawn.len() as f64;
        assert!((mean_mps - 20.0).abs() < 0.1);
        assert!(drawn.iter().all(|one| (16.0..=24.0).contains(&one.speed_mps)));
        // Headways of a Poisson process: their standard deviation is their mean.
        let headways: Vec<f64> = drawn.windows(2).map(|pair| pair[1].enters_s - pair[0].enters_s).collect();
        let mean_s = headways.iter().sum::<f64>() / headways.len() as f64;
        let deviation_s =
            (headways.iter().map(|one| (one - mean_s).powi(2)).sum::<f64>() / headways.len() as f64).sqrt();
        assert!((mean_s - 3.0).abs() < 0.1 && (deviation_s - 3.0).abs() < 0.2, "{mean_s} {deviation_s}");
    }

    #[test]
    fn a_longer_run_begins_as_a_shorter_one_and_the_shortest_headway_holds() {
        let flow = FlowConfig { headway_min_s: 2.0, ..flow() };
        let [short, long] = [100.0, 1000.0].map(|duration_s| draw(&flow, 7, duration_s));
        assert_eq!(short, long[..short.len()]);
        assert!(long.windows(2).all(|pair| pair[1].enters_s - pair[0].enters_s >= 2.0 - 1e-9));
        assert_ne!(short, draw(&flow, 8, 100.0));
    }

    #[test]
    fn rates_by_time_hold_from_their_times_on() {
        let flow = FlowConfig {
            vehicles_per_h: None,
            rates: vec![[100.0, 3600.0], [200.0, 0.0], [300.0, 1800.0]],
            headways: Headways::Even,
            headway_min_s: 0.0,
            ..flow()
        };
        let drawn = draw(&flow, 1, 400.0);
        let between =
            |from_s: f64, to_s: f64| drawn.iter().filter(|one| (from_s..to_s).contains(&one.enters_s)).count();
        assert_eq!(
            [between(0.0, 100.0), between(100.0, 200.0), between(200.0, 300.0), between(300.0, 400.0)],
            [0, 100, 0, 50]
        );
        assert!(draw(&FlowConfig { vehicles_per_h: Some(0.0), ..flow }, 1, 400.0).is_empty());
    }
}
