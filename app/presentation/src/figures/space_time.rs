//! Space-time diagrams: positions of all vehicles along a road over time, which show queues and waves.

use std::collections::BTreeSet;

use interplay_planners::State;
use interplay_planners::road::CentreLine;
use interplay_planners::road::network::Lane;
use interplay_scenarios::{LaneReference, Scenario};

use super::recorded_run::RecordedRun;
use crate::palette::{BLUE, GREEN, ORANGE, VERMILLION};
use crate::plot::style::{Dash, LineStyle};
use crate::plot::{Curve, Panel, Panels};

/// Least number of vehicles for which the diagram is drawn.
const MIN_VEHICLES: usize = 8;
/// Upper ends of the speed classes, as shares of the highest speed in the run, each with its line style.
const CLASSES: [(f64, LineStyle); 4] = [
    (0.1, LineStyle { width: 3, colour: VERMILLION.rgb, dash: Dash::Solid }),
    (0.4, LineStyle { width: 2, colour: ORANGE.rgb, dash: Dash::Solid }),
    (0.7, LineStyle { width: 2, colour: GREEN.rgb, dash: Dash::Solid }),
    (f64::INFINITY, LineStyle { width: 1, colour: BLUE.rgb, dash: Dash::Solid }),
];

/// Most lanes of a network that are drawn, the longest.
const MAX_LANES: usize = 12;

/// Positions over time, coloured by speed: one plot per lane that vehicles of a route use, with its detectors. `None` for a run with few
/// vehicles.
pub(super) fn space_time(title: &str, recorded: &RecordedRun) -> Option<Panels> {
    let scenario = &recorded.scenario;
    if scenario.vehicles.iter().filter(|vehicle| vehicle.obstacle.is_none()).count() < MIN_VEHICLES {
        return None;
    }
    let vehicles = || recorded.frames.iter().flat_map(|frame| &frame.vehicles);
    let fastest_mps = vehicles().map(|vehicle| vehicle.state.speed_mps).fold(0.0, f64::max);
    let panels = strips(scenario)?.into_iter().map(|strip| {
        let detectors = scenario.detectors.iter().filter(|one| one.lanes.contains(&strip.reference));
        Panel {
            name: format!("{}: position [m]", strip.name),
            curves: curves(recorded, &strip, fastest_mps),
            limits: detectors.map(|one| (one.along_m, format!("detector {}", one.name))).collect(),
            ..Panel::default()
        }
    });
    Some(Panels {
        title: title.to_owned(),
        across: "time [s]".to_owned(),
        columns: 1,
        panels: panels.collect(),
        ..Panels::default()
    })
}

/// A lane as a strip beside a line.
struct LaneStrip {
    name: String,
    reference: LaneReference,
    line: CentreLine,
    /// Lateral coordinates of its edges from the line \[m\].
    across_m: [f64; 2],
    /// Arc lengths of its ends \[m\].
    along_m: [f64; 2],
}

/// The parallel lanes of a road, the left one first, or the longest lanes on the routes through a network; `None` without vehicles.
fn strips(scenario: &Scenario) -> Option<Vec<LaneStrip>> {
    let driven = scenario.vehicles.iter().filter(|vehicle| vehicle.obstacle.is_none());
    if let Some(lanes) = scenario.road.parallel_lanes() {
        let line = &driven.max_by(|one, other| one.route.end_m().total_cmp(&other.route.end_m()))?.route.centre;
        let half_m = 0.5 * scenario.road.lane_width_m();
        let strip = |lane: usize| {
            let middle_m = scenario.road.lane_centre_m(Default::default(), lane).unwrap_or_default();
            LaneStrip {
                name: format!("lane {lane}"),
                reference: LaneReference::Number(lane),
                line: line.clone(),
                across_m: [middle_m - half_m, middle_m + half_m],
                along_m: [f64::NEG_INFINITY, f64::INFINITY],
            }
        };
        return Some((0..lanes.count).rev().map(strip).collect());
    }
    let network = scenario.network.as_ref()?;
    let used: BTreeSet<&str> = driven.flat_map(|one| one.route.legs.iter().map(|leg| leg.lane.as_str())).collect();
    let mut lanes: Vec<&Lane> = network.lanes().iter().filter(|lane| used.contains(lane.name.as_str())).collect();
    lanes.sort_by(|one, other| other.centre.length_m().total_cmp(&one.centre.length_m()));
    let strip = |lane: &&Lane| {
        let length_m = lane.centre.length_m();
        let half_m = 0.5 * lane.width.value(0.5 * length_m);
        LaneStrip {
            name: format!("lane {}", lane.name),
            reference: LaneReference::Name(lane.name.clone()),
            line: lane.centre.clone(),
            across_m: [-half_m, half_m],
            along_m: [0.0, length_m],
        }
    };
    Some(lanes.iter().take(MAX_LANES).map(strip).collect())
}

/// One curve per speed class. It joins the pieces of all vehicles, with breaks where a vehicle is in another class or absent.
fn curves(recorded: &RecordedRun, place: &LaneStrip, fastest_mps: f64) -> Vec<Curve> {
    let class = |state: &State| {
        let share = state.speed_mps / fastest_mps.max(f64::MIN_POSITIVE);
        CLASSES.iter().position(|(most, _)| share < *most).unwrap_or(CLASSES.len() - 1)
    };
    let mut lines: Vec<Vec<[f64; 2]>> = vec![Vec::new(); CLASSES.len()];
    for index in 0..recorded.scenario.vehicles.len() {
        let mut last: Option<(usize, [f64; 2])> = None;
        for frame in &recorded.frames {
            let Some(vehicle) = frame.vehicles.get(index) else { continue };
            let at = place.line.project(vehicle.state.position(), None);
            let is_there = !vehicle.is_absent
                && (place.across_m[0]..=place.across_m[1]).contains(&at.across_m)
                && (place.along_m[0]..=place.along_m[1]).contains(&at.along_m)
                && libm::cos(vehicle.state.heading_rad - at.heading_rad) > 0.0;
            let now = is_there.then(|| (class(&vehicle.state), [frame.time_s, at.along_m]));
            if let Some((class, point)) = now {
                match last {
                    // A piece begins where the previous one ends.
                    Some((before, from)) if before != class => lines[class].extend([[f64::NAN; 2], from]),
                    None => lines[class].push([f64::NAN; 2]),
                    Some(_) => {}
                }
                lines[class].push(point);
            }
            last = now;
        }
    }
    let mut least = 0.0;
    let named = CLASSES.into_iter().zip(lines).map(|((most, style), points)| {
        let [from_mps, to_mps] = [least, most.min(1.0)].map(|share| share * fastest_mps);
        least = most;
        Curve::new(format!("{from_mps:.1} to {to_mps:.1} m/s"), style, points)
    });
    named.collect()
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::from_text;

    use super::*;

    #[test]
    fn space_time_diagrams_are_per_lane_and_only_for_many_vehicles() {
        let text = |flow: &str| {
            format!(
                "title = 'queue'\nshows = 'cars behind a slow one'\nscale = 'full'\nduration_s = 20.0\nstep_s = 0.2\n\
                 road = {{ kind = 'lanes', lane_count = 2, lane_width_m = 3.5 }}\ndefaults = {{ driver = {{ kind = 'idm' }} }}\n\
                 [[vehicle]]\nname = 'ego'\nstart = {{ lane = 0, along_m = 120.0, speed_mps = 3.0 }}\ngoal = {{ lane = 0, speed_mps = 3.0 }}\n{flow}"
            )
        };
        let recorded = |text: &str| {
            let scenario = from_text("queue.toml", text, &[]).expect("a scenario");
            RecordedRun::record("queue", scenario, Vec::new(), "").expect("a run")
        };
        assert!(space_time("few", &recorded(&text(""))).is_none());
        let flow =
            "[[flow]]\nname = 'west'\nvehicles_per_h = 1800\nheadways = 'even'\nfrom = [0, 1]\nspeed_mps = 15.0\n";
        let panels = space_time("queue", &recorded(&text(flow))).expect("traffic");
        assert_eq!(panels.panels.len(), 2, "a plot a lane");
        let points = |curve: &Curve| curve.points.iter().filter(|[time_s, _]| time_s.is_finite()).count();
        assert!(panels.panels.iter().flat_map(|panel| &panel.curves).map(points).sum::<usize>() > 100);
        let drawing = panels.drawing();
        assert!(drawing.illegible().is_empty() && drawing.mark_count() > 20);
    }
}
