//! Pictures of a run with vehicles.

use interplay_planners::State;
use interplay_scenarios::{Branch, Scenario, Vehicle};
use interplay_simulation::frame::Frame;

use super::recorded_run::RecordedRun;
use crate::body::BodyStyle;
use crate::palette::OBSTACLE;
use crate::plot::style::{self, BLACK, BLUE, Dash, GREY, LineStyle, ORANGE};
use crate::plot::{Curve, FootprintPlot, FootprintSnapshot, FootprintVehicle, Panel, Panels};
use crate::rectangle::extent;
use crate::road_shapes::RoadShapes;

/// Number of snapshots in a picture of footprints: in strips, and the most on one map.
const SNAPSHOT_COUNTS: [usize; 2] = [8, 12];
/// Least number of snapshots on one map.
const MIN_SNAPSHOTS: usize = 5;
/// Least distance between footprints of the vehicle that drives farthest in one plan, in lengths of its body.
const FOOTPRINT_DISTANCE_LENGTHS: f64 = 1.5;
/// Time that a picture of footprints covers after the last vehicle has reached its goal \[s\].
const TIME_AFTER_GOALS_S: f64 = 1.5;
/// How far the road is traced beyond all vehicles, in lengths of the longest one; no picture shows more.
const ROAD_BEYOND_LENGTHS: f64 = 40.0;

/// The line style of every vehicle, in the scenario's order: orange for the ego, grey for obstacles.
pub fn line_styles(scenario: &Scenario) -> Vec<LineStyle> {
    let ego = scenario.ego_index();
    let mut others = style::line_styles().filter(|style| style.colour != ORANGE);
    let mut other = || others.next().unwrap_or(LineStyle::new(BLUE, Dash::Solid));
    (0..scenario.vehicles.len())
        .map(|index| match scenario.vehicles[index].obstacle {
            _ if index == ego => LineStyle::new(ORANGE, Dash::Solid),
            Some(_) => LineStyle::new(OBSTACLE.rgb, Dash::Solid),
            None => other(),
        })
        .collect()
}

/// Footprints at equal time steps, until the last goal is reached; to the end of the run if the ego does not reach its goal.
pub fn footprints(title: &str, recorded: &RecordedRun) -> FootprintPlot {
    let RecordedRun { scenario, frames, .. } = recorded;
    let strip_m = strip_m(scenario);
    let end = end_tick(recorded);
    let count = if strip_m.is_some() { SNAPSHOT_COUNTS[0] } else { count_in_one_plan(recorded, end) };
    let ego = scenario.ego_index();
    let mut order: Vec<usize> = (0..scenario.vehicles.len()).collect();
    order.sort_by_key(|&index| index != ego);
    let ticks: Vec<usize> = (0..=end).step_by(end.div_ceil(count - 1).max(1)).collect();
    let snapshot = |tick: usize| FootprintSnapshot {
        time_s: time_s(recorded, tick),
        bodies: order
            .iter()
            .map(|&index| scenario.vehicles[index].body.corners(&state(recorded, tick, index)))
            .collect(),
    };
    let line_styles = line_styles(scenario);
    let vehicle = |vehicle: &Vehicle, colour| FootprintVehicle {
        label: label(vehicle),
        colour,
        style: BodyStyle::choose(vehicle),
    };
    let last = ticks.last().copied().unwrap_or_default();
    let driven_m = extent(frames.iter().flat_map(|frame| &frame.vehicles).map(|vehicle| vehicle.state.position()));
    let lengths_m = scenario.vehicles.iter().map(|vehicle| vehicle.body.front_m + vehicle.body.rear_m);
    let beyond_m = ROAD_BEYOND_LENGTHS * lengths_m.fold(0.0, f64::max);
    let [low_m, high_m] = driven_m;
    FootprintPlot {
        title: title.to_owned(),
        road: RoadShapes::trace(scenario, [low_m.map(|part| part - beyond_m), high_m.map(|part| part + beyond_m)]),
        strip_m,
        vehicles: order.iter().map(|&index| vehicle(&scenario.vehicles[index], line_styles[index].colour)).collect(),
        snapshots: ticks.into_iter().map(snapshot).collect(),
        path: (0..=last.min(frames.len()))
            .map(|tick| (time_s(recorded, tick), state(recorded, tick, ego).position()))
            .collect(),
    }
}

/// The number of snapshots in one plan, such that the footprints of the vehicle that drives farthest do not touch.
fn count_in_one_plan(recorded: &RecordedRun, end: usize) -> usize {
    let lengths = recorded.scenario.vehicles.iter().enumerate().map(|(index, vehicle)| {
        let places =
            recorded.frames[..end].iter().filter_map(|frame| Some(frame.vehicles.get(index)?.state.position()));
        let places: Vec<[f64; 2]> = places.collect();
        let driven_m: f64 =
            places.windows(2).map(|pair| libm::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1])).sum();
        driven_m / (vehicle.body.front_m + vehicle.body.rear_m)
    });
    let apart = lengths.fold(0.0, f64::max) / FOOTPRINT_DISTANCE_LENGTHS;
    (apart as usize + 1).clamp(MIN_SNAPSHOTS, SNAPSHOT_COUNTS[1])
}

/// The last tick that a picture of footprints shows.
fn end_tick(recorded: &RecordedRun) -> usize {
    // On a network, other vehicles may drive far away before the last of them reaches its goal.
    let is_shown = |index: usize| recorded.scenario.network.is_none() || index == recorded.scenario.ego_index();
    let vehicles = recorded.report.vehicles.iter().enumerate().filter(|(index, _)| is_shown(*index));
    let completed = vehicles.filter_map(|(_, vehicle)| vehicle.completed_s);
    let step_s = recorded.scenario.step_s;
    let last = (completed.fold(0.0, f64::max) + TIME_AFTER_GOALS_S) / step_s;
    let whole = recorded.report.vehicles.get(recorded.scenario.ego_index()).is_none_or(|ego| ego.completed_s.is_none());
    if whole { recorded.frames.len() } else { (last.round() as usize).min(recorded.frames.len()) }
}

fn time_s(recorded: &RecordedRun, tick: usize) -> f64 {
    recorded.frames.get(tick).map_or(tick as f64 * recorded.scenario.step_s, |frame| frame.time_s)
}

/// The state of a vehicle at the start of a tick; after the last tick, its final state.
fn state(recorded: &RecordedRun, tick: usize, index: usize) -> State {
    let seen = recorded.frames.get(tick).and_then(|frame| frame.vehicles.get(index)).map(|vehicle| vehicle.state);
    seen.or(recorded.report.vehicles.get(index).map(|vehicle| vehicle.last)).unwrap_or_default()
}

/// The label of a vehicle, its name and driver; all obstacles share one label.
fn label(vehicle: &Vehicle) -> String {
    match vehicle.obstacle {
        Some(_) => "obstacles".to_owned(),
        None => format!("{}: {}", vehicle.name, vehicle.driver.description()),
    }
}

/// Lateral coordinates of the edges of the straight road that all vehicles drive on; none if roads cross or turn.
fn strip_m(scenario: &Scenario) -> Option<[f64; 2]> {
    let has_one_road = scenario.vehicles.iter().all(|vehicle| vehicle.road == Branch::Main);
    let corridor = scenario.road.corridor(Branch::Main).filter(|_| has_one_road)?;
    Some([corridor.right_m, corridor.left_m])
}

/// Speeds over time, with vertical lines at the times at which vehicles reach their goals.
pub fn speeds(title: &str, recorded: &RecordedRun) -> Panels {
    let panel = Panel { reaches: vec![0.0], ..each_vehicle(recorded, "speed [m/s]", |state, _| state.speed_mps) };
    over_time(title, vec![panel])
}

/// Speeds, the smallest gap of the ego, and accelerations over time.
pub fn motion(title: &str, recorded: &RecordedRun) -> Panels {
    let mut panels = vec![each_vehicle(recorded, "speed [m/s]", |state, _| state.speed_mps)];
    let gaps: Vec<[f64; 2]> = vehicle_frames(recorded).filter_map(|frame| Some([frame.time_s, frame.gap_m?])).collect();
    if !gaps.is_empty() {
        let curve = Curve::new("smallest gap of the ego", LineStyle::new(BLACK, Dash::Solid), gaps);
        panels.push(Panel {
            name: "gap between footprints [m]".to_owned(),
            curves: vec![curve],
            reaches: vec![0.0],
            ..Panel::default()
        });
    }
    panels.push(each_vehicle(recorded, "acceleration [m/s²]", |_, acceleration_mps2| acceleration_mps2));
    over_time(title, panels)
}

fn vehicle_frames(recorded: &RecordedRun) -> impl Iterator<Item = &Frame> {
    recorded.frames.iter().filter(|frame| !frame.vehicles.is_empty())
}

fn over_time(title: &str, panels: Vec<Panel>) -> Panels {
    Panels { title: title.to_owned(), across: "time [s]".to_owned(), columns: 1, every: None, panels }
}

/// A curve of a quantity for each vehicle with a driver.
fn each_vehicle(recorded: &RecordedRun, name: &str, value: fn(&State, f64) -> f64) -> Panel {
    let mut panel = Panel { name: name.to_owned(), ..Panel::default() };
    let vehicles = recorded.scenario.vehicles.iter().zip(line_styles(&recorded.scenario));
    let all = vehicles.enumerate().zip(&recorded.report.vehicles);
    for ((index, (vehicle, style)), seen) in all.filter(|((_, (vehicle, _)), _)| vehicle.obstacle.is_none()) {
        let points = vehicle_frames(recorded).map(|frame| {
            let vehicle = &frame.vehicles[index];
            [frame.time_s, value(&vehicle.state, vehicle.input.acceleration_mps2)]
        });
        panel.curves.push(Curve::new(&vehicle.name, style, points.collect()));
        if let Some(completed_s) = seen.completed_s {
            let upright = LineStyle::new(style.colour, Dash::Short);
            panel.events.push((completed_s, upright, format!("{} reaches its goal", vehicle.name)));
        }
    }
    panel
}

/// The diagnostics of a vehicle's planner over time; `None` if the planner has no plots, or reported no values for them.
pub fn planner_diagnostics(title: &str, recorded: &RecordedRun, index: usize) -> Option<Panels> {
    let mut panels = Vec::new();
    for plot in recorded.scenario.vehicles[index].driver.explanation().plots {
        let mut curves = Vec::new();
        for (quantity, style) in plot.quantities.iter().zip(style::line_styles()) {
            let value = |frame: &Frame| frame.vehicles[index].plan.value_of(quantity).unwrap_or(f64::NAN);
            let points: Vec<[f64; 2]> = vehicle_frames(recorded).map(|frame| [frame.time_s, value(frame)]).collect();
            if points.iter().any(|point| point[1].is_finite()) {
                curves.push(Curve::new(quantity.name, style, points));
            }
        }
        if !curves.is_empty() {
            panels.push(Panel { name: plot.title_with_unit(), curves, ..Panel::default() });
        }
    }
    let refused = failure_times_s(recorded, index);
    if let Some(first) = panels.first_mut() {
        let upright = LineStyle::new(GREY, Dash::Short);
        first.events = refused.into_iter().map(|time_s| (time_s, upright, "no plan: fallback".to_owned())).collect();
    }
    (!panels.is_empty()).then(|| over_time(title, panels))
}

/// The times at which a planner failed \[s\].
fn failure_times_s(recorded: &RecordedRun, index: usize) -> Vec<f64> {
    let failed = |frame: &&Frame| frame.vehicles[index].origin != interplay_simulation::frame::Origin::Planned;
    vehicle_frames(recorded).filter(failed).map(|frame| frame.time_s).collect()
}
