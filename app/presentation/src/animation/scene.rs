//! The visible state of the vehicles at any time of a run, interpolated between ticks.

use interplay_planners::State;
use interplay_scenarios::Scenario;
use interplay_simulation::frame::{Frame, Origin, VehicleFrame};

use super::flow;
use super::timing::RunTimes;
use crate::camera::{car_m, partners};
use crate::figures::RecordedRun;
use crate::palette::{Colour, OTHERS, UNNAMED, VERMILLION, vehicle_colours};
use crate::requests::Requests;
use crate::shown_extent::nearest_vehicles;
use crate::signals::{indicator_side, is_braking, wrapped};
use interplay_planners::scene::IndicatorSide;

/// How long an indicator is lit and dark \[s\], in the picture's time.
const BLINK_S: f64 = 0.32;

/// Vehicles beyond this distance no longer interact with the ego, in lengths of a car.
const NEAR_CARS: f64 = 30.0;

/// The visible state of a vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct SeenVehicle {
    pub colour: Colour,
    /// Whether it has a name and a plan in pictures; in a crowd, only those near the ego have.
    pub is_named: bool,
    /// Whether it is not on the road.
    pub is_absent: bool,
    pub state: State,
    /// Steering angle of the front wheels \[rad\].
    pub steering_rad: f64,
    /// Whether its brake lights are on.
    pub brakes: bool,
    /// The side of the active indicator, which may be dark while it blinks.
    pub turn: Option<IndicatorSide>,
    /// Whether an active indicator is lit.
    pub blinks: bool,
    /// The planned positions from now on \[m\].
    pub plan: Vec<[f64; 2]>,
    /// The colour of the plan: its own, or that of a failure if the plan is a fallback.
    pub plan_colour: Colour,
    /// Positions of the other continuations of a plan that branches \[m\].
    pub branches: Vec<Vec<[f64; 2]>>,
    /// Positions of the motions that it proposes to other vehicles \[m\].
    pub proposals: Vec<Vec<[f64; 2]>>,
}

/// All ticks of a run with vehicles.
pub struct DrivingRun<'a> {
    pub scenario: &'a Scenario,
    /// One colour a vehicle, for each tick.
    colours: Vec<Vec<Colour>>,
    pub frames: Vec<&'a Frame>,
    /// The open requests at each tick.
    requests: Vec<Requests>,
    /// The end of the run \[s\], and the final state of every vehicle.
    end: (f64, Vec<State>),
    /// The stated end of the animation, if there is one \[s\].
    until_s: Option<f64>,
}

impl<'a> DrivingRun<'a> {
    /// Indices of the vehicles that have a driver.
    pub fn driven(&self) -> impl Iterator<Item = usize> + '_ {
        let vehicles = self.scenario.vehicles.iter().enumerate();
        vehicles.filter(|(_, vehicle)| vehicle.obstacle.is_none()).map(|(index, _)| index)
    }

    /// The vehicles of a run; `None` without vehicles.
    pub fn from_run(recorded: &'a RecordedRun) -> Option<DrivingRun<'a>> {
        let frames: Vec<&Frame> = recorded.frames.iter().filter(|frame| !frame.vehicles.is_empty()).collect();
        let last = frames.last()?;
        let scenario = &recorded.scenario;
        let colours = colours(scenario, &frames);
        let end = recorded.report.vehicles.iter().map(|vehicle| vehicle.last).collect();
        let end = (last.time_s + scenario.step_s, end);
        let asked = |requests: &mut Requests, frame: &&Frame| {
            requests.observe(scenario, frame);
            Some(requests.clone())
        };
        let requests = frames.iter().scan(Requests::default(), asked).collect();
        Some(DrivingRun { scenario, colours, frames, requests, end, until_s: recorded.shown_until_s })
    }

    /// Whether a vehicle is named at a tick. In a crowd, only vehicles near the ego are, and none where all are of flows.
    pub fn is_named(&self, frame: &Frame, vehicle: &str) -> bool {
        let index = self.scenario.index_of(vehicle);
        index.is_none_or(|index| self.names(self.tick(frame.time_s), index))
    }

    fn names(&self, tick: usize, vehicle: usize) -> bool {
        !self.scenario.is_flow_alone() && self.colours[tick][vehicle] != UNNAMED
    }

    /// The colours that vehicles have at some tick.
    pub fn used_colours(&self) -> Vec<Colour> {
        let mut used: Vec<Colour> = self.colours.iter().flatten().copied().collect();
        used.sort_unstable();
        used.dedup();
        used
    }

    /// The times that limit the animation.
    pub fn times(&self) -> RunTimes {
        let time_ratio = self.scenario.ego().map_or(1.0, |ego| ego.body.time_ratio());
        RunTimes {
            ego: self.scenario.ego_index(),
            end_s: self.end_s(),
            settled_s: self.settled_s(),
            until_s: self.until_s,
            is_flow: self.scenario.is_flow_alone(),
            time_ratio,
        }
    }

    /// The time at which the run ends \[s\].
    pub fn end_s(&self) -> f64 {
        self.end.0
    }

    /// The last tick that began at a time or before it.
    pub fn frame(&self, time_s: f64) -> &'a Frame {
        self.frames[self.tick(time_s)]
    }

    /// The time at which the interactions of the ego end \[s\]: no passing order is open, and no former partner nearby comes nearer.
    /// `None` if the ego has no partners, or interacts until the end.
    pub fn settled_s(&self) -> Option<f64> {
        let ego = self.scenario.ego_index();
        let near_m = NEAR_CARS * car_m(self.scenario);
        let distance_m = |frame: &Frame, other: usize| {
            let [a, b] = [ego, other].map(|index| frame.vehicles[index].state.position());
            libm::hypot(a[0] - b[0], a[1] - b[1])
        };
        let mut known: Vec<usize> = Vec::new();
        let mut last = None;
        for (tick, pair) in self.frames.windows(2).enumerate() {
            let partners = partners(self.scenario, &pair[0].vehicles[ego]);
            let is_open = !pair[0].vehicles[ego].plan.homotopy_class.is_empty();
            known.extend(partners);
            let comes = |other: &usize| {
                let [before_m, after_m] = [pair[0], pair[1]].map(|frame| distance_m(frame, *other));
                after_m < before_m && after_m < near_m
            };
            if is_open || known.iter().any(comes) {
                last = Some(tick + 1);
            }
        }
        last.filter(|tick| tick + 1 < self.frames.len()).map(|tick| self.frames[tick].time_s)
    }

    /// The open requests at a tick.
    pub fn requests(&self, frame: &Frame) -> &Requests {
        &self.requests[self.tick(frame.time_s)]
    }

    /// The vehicles with which the ego interacts at a time, by index.
    pub fn partners(&self, time_s: f64) -> Vec<usize> {
        partners(self.scenario, &self.frame(time_s).vehicles[self.scenario.ego_index()])
    }

    /// The index of the last tick that began at a time or before it.
    fn tick(&self, time_s: f64) -> usize {
        self.frames.partition_point(|frame| frame.time_s <= time_s + 1e-9).saturating_sub(1)
    }

    /// Every vehicle at a time, in the scenario's order. Indicators blink by `shown_s`, the time within the animation.
    pub fn seen(&self, time_s: f64, shown_s: f64) -> Vec<SeenVehicle> {
        let tick = self.tick(time_s);
        let frame = self.frames[tick];
        let next_s = self.frames.get(tick + 1).map_or(self.end.0, |frame| frame.time_s);
        let share = ((time_s - frame.time_s) / (next_s - frame.time_s).max(1e-9)).clamp(0.0, 1.0);
        let blinks = ((shown_s / BLINK_S) as usize).is_multiple_of(2);
        let seen = |(index, vehicle): (usize, &VehicleFrame)| {
            let state = self.state(index, tick, share);
            let turn = indicator_side(self.scenario, &self.scenario.vehicles[index], vehicle);
            let failed = vehicle.origin != Origin::Planned;
            let colour = self.colours[tick][index];
            SeenVehicle {
                colour,
                is_named: self.names(tick, index),
                is_absent: vehicle.is_absent,
                state,
                steering_rad: vehicle.input.steering_rad,
                brakes: is_braking(vehicle.input.acceleration_mps2) && state.speed_mps > 1e-3,
                turn,
                blinks,
                plan: positions_ahead(&vehicle.plan.trajectory.states, &state),
                plan_colour: if failed { VERMILLION.rgb } else { colour },
                branches: {
                    let branches = vehicle.plan.branches.iter();
                    branches.map(|branch| positions_ahead(&branch.trajectory.states, &state)).collect()
                },
                proposals: {
                    let proposals = self.requests[tick].proposals(frame, index);
                    proposals.map(|proposal| proposal.trajectory.states.iter().map(State::position).collect()).collect()
                },
            }
        };
        let mut seen: Vec<SeenVehicle> = frame.vehicles.iter().enumerate().map(seen).collect();
        // The camera must not follow an absent vehicle, so it gets the position of the ego.
        let ego = seen[self.scenario.ego_index()].state;
        seen.iter_mut().filter(|seen| seen.is_absent).for_each(|seen| seen.state = ego);
        seen
    }

    /// The state of a vehicle when a share of a tick has passed.
    fn state(&self, index: usize, tick: usize, share: f64) -> State {
        let at = |tick: usize| match self.frames.get(tick) {
            Some(frame) => frame.vehicles[index].state,
            None => self.end.1[index],
        };
        let [before, from, to, after] = [tick.saturating_sub(1), tick, tick + 1, tick + 2].map(at);
        let between = |values: [f64; 4]| spline(values, share);
        let turned = |state: State| from.heading_rad + wrapped(state.heading_rad - from.heading_rad);
        State {
            x_m: between([before.x_m, from.x_m, to.x_m, after.x_m]),
            y_m: between([before.y_m, from.y_m, to.y_m, after.y_m]),
            heading_rad: from.heading_rad + share * (turned(to) - from.heading_rad),
            speed_mps: from.speed_mps + share * (to.speed_mps - from.speed_mps),
        }
    }
}

/// The value between the second and the third of four values at equal distances: the cubic of Catmull and Rom.
fn spline([a, b, c, d]: [f64; 4], t: f64) -> f64 {
    let (slope, end_slope) = (0.5 * (c - a), 0.5 * (d - b));
    let (squared, cubed) = (t * t, t * t * t);
    (2.0 * cubed - 3.0 * squared + 1.0) * b
        + (cubed - 2.0 * squared + t) * slope
        + (3.0 * squared - 2.0 * cubed) * c
        + (cubed - squared) * end_slope
}

/// The positions of a plan ahead of the present state, which is the first of them.
fn positions_ahead(states: &[State], now: &State) -> Vec<[f64; 2]> {
    let later = states.iter().skip(1).map(State::position);
    let mut points = vec![now.position()];
    let (sin, cos) = libm::sincos(now.heading_rad);
    points.extend(later.filter(|[x, y]| cos * (x - now.x_m) + sin * (y - now.y_m) > 0.0));
    points
}

/// A vehicle keeps its colour while it is among this many nearest to the ego, so that colours do not flicker.
const KEPT_AMONG: usize = OTHERS.len() + 3;

/// The colour of each vehicle at each tick: that of its flow where all are of flows. Otherwise, with more vehicles than colours, those
/// nearest to the ego have one, and all others are [`UNNAMED`].
pub fn colours(scenario: &Scenario, frames: &[&Frame]) -> Vec<Vec<Colour>> {
    if scenario.is_flow_alone() {
        return vec![flow::colours(scenario); frames.len()];
    }
    let usual: Vec<Colour> = vehicle_colours(scenario).into_iter().map(|colour| colour.rgb).collect();
    let ego = scenario.ego_index();
    let is_other = |index: usize| index != ego && scenario.vehicles[index].obstacle.is_none();
    if (0..usual.len()).filter(|index| is_other(*index)).count() <= OTHERS.len() {
        return vec![usual; frames.len()];
    }
    let mut holders: [Option<usize>; OTHERS.len()] = [None; OTHERS.len()];
    let at = |frame: &&Frame| {
        let near = nearest_vehicles(scenario, frame);
        for holder in &mut holders {
            *holder = holder.filter(|vehicle| near.iter().take(KEPT_AMONG).any(|other| other == vehicle));
        }
        for vehicle in near.iter().take(OTHERS.len()) {
            let is_coloured = holders.contains(&Some(*vehicle));
            if let Some(free) = holders.iter_mut().find(|holder| holder.is_none()).filter(|_| !is_coloured) {
                *free = Some(*vehicle);
            }
        }
        let colour = |index: usize| match holders.iter().position(|holder| *holder == Some(index)) {
            Some(number) => OTHERS[number].rgb,
            None if is_other(index) => UNNAMED,
            None => usual[index],
        };
        (0..usual.len()).map(colour).collect()
    };
    frames.iter().map(at).collect()
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::{from_text, load};

    use super::*;
    use crate::figures::RecordedRun;

    fn recorded(name: &str) -> RecordedRun {
        let scenario = load(name, &[]).expect("embedded");
        RecordedRun::record(name, scenario, Vec::new(), "").expect("a run")
    }

    #[test]
    fn drawn_states_equal_the_run_at_ticks_and_are_smooth_between_them() {
        let recorded = recorded("lane-change/front-nice");
        let run = DrivingRun::from_run(&recorded).expect("vehicles");
        for frame in &run.frames {
            let seen = run.seen(frame.time_s, 0.0);
            for (seen, vehicle) in seen.iter().zip(&frame.vehicles) {
                assert!((seen.state.x_m - vehicle.state.x_m).abs() < 1e-9);
            }
        }
        let step_s = recorded.scenario.step_s;
        for index in 0..recorded.scenario.vehicles.len() {
            let places: Vec<f64> =
                (0..=60).map(|part| run.seen(0.1 * step_s * f64::from(part), 0.0)[index].state.x_m).collect();
            let steps: Vec<f64> = places.windows(2).map(|pair| pair[1] - pair[0]).collect();
            assert!(steps.iter().all(|step| *step > 0.0), "{steps:?}");
        }
        let (end, last) = (run.seen(1e3, 0.0)[0].state, recorded.report.vehicles[0].last);
        let off = end.to_array().iter().zip(last.to_array()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-9, "{end:?} {last:?}");
    }

    #[test]
    fn brake_lights_are_lit_exactly_while_braking() {
        let recorded = recorded("roundabout/nice");
        let run = DrivingRun::from_run(&recorded).expect("vehicles");
        let (mut lit, mut dark) = (0, 0);
        for frame in &run.frames {
            for (seen, vehicle) in run.seen(frame.time_s, 0.0).iter().zip(&frame.vehicles) {
                let brakes = vehicle.input.acceleration_mps2 < -0.1 && vehicle.state.speed_mps > 1e-3;
                assert_eq!(seen.brakes, brakes, "{} at {} s", vehicle.name, frame.time_s);
                if brakes { lit += 1 } else { dark += 1 }
            }
        }
        assert!(lit > 10 && dark > 10, "{lit} {dark}");
    }

    /// On a ring the ego indicates right at the exit only. It indicates left for a left turn and from a ramp, and left and then right
    /// to overtake.
    #[test]
    fn turns_and_lane_changes_are_indicated() {
        let turns = |name: &str| {
            let recorded = recorded(name);
            let run = DrivingRun::from_run(&recorded).expect("vehicles");
            let ego = recorded.scenario.ego_index();
            let mut turns: Vec<IndicatorSide> =
                run.frames.iter().filter_map(|frame| run.seen(frame.time_s, 0.0)[ego].turn).collect();
            turns.dedup();
            turns
        };
        assert_eq!(turns("roundabout/nice"), [IndicatorSide::Right]);
        assert_eq!(turns("left-turn/nice"), [IndicatorSide::Left]);
        assert_eq!(turns("on-ramp/five"), [IndicatorSide::Left]);
        assert_eq!(turns("overtaking/oncoming"), [IndicatorSide::Left, IndicatorSide::Right]);
    }

    /// The ego of this scenario changes to the lane on its left, and indicates before it is there.
    #[test]
    fn an_indicator_is_on_before_a_lane_change() {
        let recorded = recorded("lane-change/front-nice");
        let run = DrivingRun::from_run(&recorded).expect("vehicles");
        let ego = recorded.scenario.ego_index();
        let first = run.seen(0.0, 0.0)[ego].state.y_m;
        let last = recorded.report.vehicles[ego].last.y_m;
        let to = if last > first { IndicatorSide::Left } else { IndicatorSide::Right };
        let middle = 0.5 * (first + last);
        let crossing =
            run.frames.iter().position(|frame| (frame.vehicles[ego].state.y_m - middle) * (last - middle) > 0.0);
        let crossing_s = run.frames[crossing.expect("it changes lanes")].time_s;
        let before = run.frames.iter().filter(|frame| frame.time_s < crossing_s);
        let indicated = before.filter(|frame| run.seen(frame.time_s, 0.0)[ego].turn == Some(to)).count();
        assert!(indicated > 3, "{indicated} ticks before {crossing_s} s");
        assert!(run.seen(run.end_s() - 0.01, 0.0)[ego].turn.is_none(), "nothing to indicate in its lane");
    }

    /// Of twelve cars, the ego and the five nearest ones have colours, all different.
    #[test]
    fn in_a_crowd_the_nearest_vehicles_have_colours() {
        let vehicle = |number: u32| {
            let name = if number == 6 { "ego".to_owned() } else { format!("car-{number}") };
            let along_m = 15.0 * f64::from(number);
            format!(
                "[[vehicle]]\nname = '{name}'\nstart = {{ lane = 0, along_m = {along_m}, speed_mps = 8.0 }}\n\
                 goal = {{ speed_mps = 8.0 }}\ndriver = {{ kind = 'idm' }}\n"
            )
        };
        let vehicles: String = (0..12).map(vehicle).collect();
        let text = format!(
            "title = 'a'\nshows = 'b'\nduration_s = 1.0\n[defaults]\nclass = 'car'\n[road]\nkind = 'lanes'\nlane_width_m = 3.5\n{vehicles}"
        );
        let scenario = from_text("row.toml", &text, &[]).expect("a scenario without fault");
        let recorded = RecordedRun::record("row", scenario, Vec::new(), "").expect("a run");
        let frames: Vec<&Frame> = recorded.frames.iter().collect();
        for colours in colours(&recorded.scenario, &frames) {
            let mut named: Vec<Colour> = colours.into_iter().filter(|colour| *colour != UNNAMED).collect();
            named.sort_unstable();
            assert_eq!(named.len(), 6);
            named.dedup();
            assert_eq!(named.len(), 6);
        }
    }
}
