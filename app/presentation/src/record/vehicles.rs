//! Vehicles of a recording: bodies, past paths, plans and predictions.

use std::sync::Arc;

use interplay_planners::prediction::spread_m;
use interplay_planners::{Body, Proposal, Route, State, Trajectory};
use interplay_scenarios::Scenario;
use interplay_simulation::frame::{Origin, VehicleFrame};
use rerun::{RecordingStream, RecordingStreamResult};

use super::car;
use super::palette::{FAILURE, NEUTRAL, NamedColour, opaque};
use super::re_sdk_types::archetypes::{LineStrips3D, Points3D, Transform3D};
use super::re_sdk_types::components::Radius;
use super::road::rotation;
use super::{Logged, RecordedTick};
use crate::palette::{BRAKE_LIGHT, INDICATOR};
use crate::shown_extent::labelled;
use crate::signals::{indicator_side, is_braking};
use interplay_planners::scene::IndicatorSide;

/// Heights of ellipses, paths, predictions, branches, plans and proposals above the road, in widths of a body.
const ELLIPSE_WIDTHS: f64 = 0.03;
const TRACE_WIDTHS: f64 = 0.04;
const PREDICTION_WIDTHS: f64 = 0.05;
const BRANCH_WIDTHS: f64 = 0.06;
const PLAN_WIDTHS: f64 = 0.07;
const PROPOSAL_WIDTHS: f64 = 0.25;
/// Half length of a bar at an end of the spread of a prediction, in widths of a body.
const BAR_WIDTHS: f64 = 0.25;
/// How far ahead the spread of a prediction is drawn \[s\].
const SPREAD_S: [f64; 3] = [1.0, 2.0, 3.0];
/// Radius of a light, in widths of a body.
const LIGHT_WIDTHS: f64 = 0.1;
/// The pose of a hidden object: too small to be visible, since the viewer refuses a scale of zero.
const HIDDEN: [[f32; 3]; 3] = [[1e-6, 0.0, 0.0], [0.0, 1e-6, 0.0], [0.0, 0.0, 1e-6]];
const ELLIPSE_POINTS: u16 = 72;

/// All vehicles, in the scenario's order.
pub struct VehicleLayer {
    vehicles: Vec<DrawnVehicle>,
    ego: usize,
}

/// A vehicle and what was last logged of it.
struct DrawnVehicle {
    /// `world/vehicle/<name>`.
    path: String,
    vehicle_colour: NamedColour,
    body: Body,
    route: Arc<Route>,
    /// The time step of its expected motion, if the others see its motion only \[s\].
    seen_step_s: Option<f64>,
    last: Option<State>,
    /// Whether it was absent at the last tick.
    is_absent: bool,
    /// Whether its plans are drawn.
    shows_intent: bool,
    /// Whether its safety ellipse is drawn, which the ego keeps out of.
    has_ellipse: bool,
    has_request: bool,
    /// Whether its last plan had branches.
    branches: bool,
    /// The last logged state of its lights.
    brakes: bool,
    turns: Option<IndicatorSide>,
}

impl VehicleLayer {
    /// Logs the static properties of the vehicles: shapes, colours, widths.
    pub fn begin(
        stream: &RecordingStream,
        scenario: &Scenario,
        vehicle_colours: &[NamedColour],
    ) -> RecordingStreamResult<VehicleLayer> {
        let ego = scenario.ego_index();
        let mut vehicles = Vec::new();
        for (index, (vehicle, vehicle_colour)) in scenario.vehicles.iter().zip(vehicle_colours).enumerate() {
            let drawn = DrawnVehicle {
                path: format!("world/vehicle/{}", vehicle.name),
                vehicle_colour: *vehicle_colour,
                body: vehicle.body,
                route: Arc::clone(&vehicle.route),
                seen_step_s: (!vehicle.tells_plan()).then_some(scenario.step_s),
                last: None,
                is_absent: false,
                shows_intent: false,
                has_ellipse: index != ego,
                has_request: false,
                branches: false,
                brakes: false,
                turns: None,
            };
            let mesh = car::mesh(vehicle, vehicle_colour.rgb);
            stream.log_static(format!("{}/body/mesh", drawn.path), &mesh.to_component())?;
            drawn.log_style(stream)?;
            vehicles.push(drawn);
        }
        if let Some(vehicle) = scenario.ego() {
            for (_, other) in vehicles.iter().enumerate().filter(|(index, _)| *index != ego) {
                let ring = ellipse([vehicle.safety.along_m, vehicle.safety.across_m], other.z(ELLIPSE_WIDTHS));
                let ellipse =
                    LineStrips3D::new([ring]).with_colors([NEUTRAL.solid()]).with_radii([Radius::new_ui_points(0.7)]);
                stream.log_static(format!("{}/safety", other.path), &ellipse)?;
            }
        }
        Ok(VehicleLayer { vehicles, ego })
    }

    pub fn log_frame(&mut self, tick: &RecordedTick) -> Logged {
        let RecordedTick { stream, scenario, frame, requests, described, .. } = *tick;
        let labelled = labelled(scenario, frame);
        for (index, (drawn, vehicle)) in self.vehicles.iter_mut().zip(&frame.vehicles).enumerate() {
            let open: Vec<&Proposal> = requests.proposals(frame, index).collect();
            if drawn.log_absence(stream, vehicle.is_absent)? {
                continue;
            }
            drawn.log_motion(stream, &vehicle.state)?;
            drawn.log_lights(stream, vehicle, indicator_side(scenario, &scenario.vehicles[index], vehicle))?;
            if !described[index] {
                drawn.hide_intent(stream)?;
                continue;
            }
            // Between two plans the last one stays valid; in a crowd it is not logged again.
            if frame.plans || !drawn.shows_intent || !scenario.is_crowd() {
                drawn.log_intent(stream, vehicle, &open)?;
            }
            if !labelled[index] {
                drawn.hide_ellipse(stream)?;
            } else if index != self.ego {
                drawn.has_ellipse = true;
                let heading_rad = drawn.route.locate(vehicle.state.position(), None).heading_rad;
                let place = pose(&State { heading_rad, ..vehicle.state });
                stream.log(format!("{}/safety", drawn.path), &place)?;
            }
        }
        Ok(())
    }
}

impl DrawnVehicle {
    fn at(&self, part: &str) -> String {
        format!("{}/{part}", self.path)
    }

    /// A height \[m\] from a height in widths of the body.
    fn z(&self, widths: f64) -> f64 {
        widths * self.body.width_m
    }

    fn log_style(&self, stream: &RecordingStream) -> Logged {
        let style = |share: f64, points: f32| {
            LineStrips3D::update_fields()
                .with_colors([self.vehicle_colour.on_asphalt(share)])
                .with_radii([Radius::new_ui_points(points)])
        };
        stream.log_static(self.at("prediction"), &style(0.7, 1.0))?;
        stream.log_static(self.at("trace"), &style(0.45, 1.5))?;
        stream.log_static(self.at("branches"), &style(0.8, 1.4))?;
        let plan = LineStrips3D::update_fields().with_radii([Radius::new_ui_points(2.2)]);
        stream.log_static(self.at("plan"), &plan)?;
        let dots = Points3D::update_fields().with_colors([self.vehicle_colour.solid()]);
        stream.log_static(self.at("proposal"), &dots.with_radii([Radius::new_ui_points(3.0)]))?;
        let radius = Radius::new_scene_units(self.z(LIGHT_WIDTHS) as f32);
        for (part, colour) in [("brake-lights", BRAKE_LIGHT), ("indicators", INDICATOR)] {
            let lights = Points3D::update_fields().with_colors([opaque(colour)]).with_radii([radius]);
            stream.log_static(self.at(&format!("body/{part}")), &lights)?;
        }
        Ok(())
    }

    /// Hides an absent vehicle. Returns `is_absent`.
    fn log_absence(&mut self, stream: &RecordingStream, is_absent: bool) -> RecordingStreamResult<bool> {
        if is_absent && !self.is_absent {
            self.last = None;
            let hidden = Transform3D::update_fields().with_mat3x3(HIDDEN);
            stream.log(self.at("body"), &hidden)?;
            stream.log(self.at("safety"), &hidden)?;
            for line in ["plan", "prediction", "trace", "branches"] {
                stream.log(self.at(line), &strips([]))?;
            }
        }
        self.is_absent = is_absent;
        self.shows_intent &= !is_absent;
        Ok(is_absent)
    }

    /// Removes plan, prediction, branches and ellipse.
    fn hide_intent(&mut self, stream: &RecordingStream) -> Logged {
        self.hide_ellipse(stream)?;
        if std::mem::take(&mut self.shows_intent) {
            for line in ["plan", "prediction", "branches"] {
                stream.log(self.at(line), &strips([]))?;
            }
        }
        Ok(())
    }

    fn hide_ellipse(&mut self, stream: &RecordingStream) -> Logged {
        if std::mem::take(&mut self.has_ellipse) {
            stream.log(self.at("safety"), &Transform3D::update_fields().with_mat3x3(HIDDEN))?;
        }
        Ok(())
    }

    fn log_motion(&mut self, stream: &RecordingStream, state: &State) -> Logged {
        stream.log(self.at("body"), &pose(state))?;
        if let Some(last) = self.last.replace(*state) {
            let height_m = self.z(TRACE_WIDTHS);
            stream.log(self.at("trace"), &strips([vec![point(&last, height_m), point(state, height_m)]]))?;
        }
        Ok(())
    }

    fn log_intent(&mut self, stream: &RecordingStream, vehicle: &VehicleFrame, requests: &[&Proposal]) -> Logged {
        self.shows_intent = true;
        let plan_colour = if vehicle.origin == Origin::Planned { self.vehicle_colour } else { FAILURE };
        let plan = strips([points(&vehicle.plan.trajectory, self.z(PLAN_WIDTHS))]).with_colors([plan_colour.solid()]);
        stream.log(self.at("plan"), &plan)?;
        let mut expected = dashes(&vehicle.prediction, self.z(PREDICTION_WIDTHS));
        if let Some(step_s) = self.seen_step_s {
            expected.extend(self.spread_bars(&vehicle.prediction, step_s));
        }
        stream.log(self.at("prediction"), &strips(expected))?;
        if !requests.is_empty() || self.has_request {
            self.has_request = !requests.is_empty();
            let dots = requests.iter().flat_map(|proposal| points(&proposal.trajectory, self.z(PROPOSAL_WIDTHS)));
            stream.log(self.at("proposal"), &Points3D::update_fields().with_positions(dots))?;
        }
        let branches = &vehicle.plan.branches;
        if !branches.is_empty() || self.branches {
            self.branches = !branches.is_empty();
            let lines: Vec<_> =
                branches.iter().map(|branch| points(&branch.trajectory, self.z(BRANCH_WIDTHS))).collect();
            stream.log(self.at("branches"), &strips(lines))?;
        }
        Ok(())
    }

    /// Bars across the way at the ends of where the others expect the vehicle who see its motion only, after some seconds.
    fn spread_bars(&self, expected: &Trajectory, step_s: f64) -> impl Iterator<Item = Vec<[f32; 3]>> {
        let (height_m, half_m) = (self.z(PREDICTION_WIDTHS), self.z(BAR_WIDTHS));
        let after = move |time_s: f64| Some((time_s, expected.states.get((time_s / step_s).round() as usize)?));
        SPREAD_S.into_iter().filter_map(after).flat_map(move |(time_s, state)| {
            let reach_m = spread_m(&self.body, time_s);
            let (sin, cos) = libm::sincos(state.heading_rad);
            [-reach_m, reach_m].map(|along_m| {
                let beside = |across_m: f64| {
                    let (x_m, y_m) =
                        (state.x_m + along_m * cos - across_m * sin, state.y_m + along_m * sin + across_m * cos);
                    point(&State { x_m, y_m, ..*state }, height_m)
                };
                vec![beside(-half_m), beside(half_m)]
            })
        })
    }

    /// Logs brake lights and indicators where they change.
    fn log_lights(&mut self, stream: &RecordingStream, vehicle: &VehicleFrame, turns: Option<IndicatorSide>) -> Logged {
        let lights = |places: Option<[[f64; 3]; 2]>| {
            let places = places.into_iter().flatten().map(|place| place.map(|part| part as f32));
            Points3D::update_fields().with_positions(places)
        };
        let brakes = is_braking(vehicle.input.acceleration_mps2) && vehicle.state.speed_mps > 1e-3;
        if brakes != self.brakes {
            self.brakes = brakes;
            let places = brakes.then(|| car::brake_lights(&self.body));
            stream.log(self.at("body/brake-lights"), &lights(places))?;
        }
        if turns != self.turns {
            self.turns = turns;
            let places = turns.map(|turn| car::indicators(&self.body, turn == IndicatorSide::Left));
            stream.log(self.at("body/indicators"), &lights(places))?;
        }
        Ok(())
    }
}

fn point(state: &State, height_m: f64) -> [f32; 3] {
    [state.x_m as f32, state.y_m as f32, height_m as f32]
}

fn points(trajectory: &Trajectory, height_m: f64) -> Vec<[f32; 3]> {
    trajectory.states.iter().map(|state| point(state, height_m)).collect()
}

fn strips(strips: impl IntoIterator<Item = Vec<[f32; 3]>>) -> LineStrips3D {
    LineStrips3D::update_fields().with_strips(strips)
}

/// A trajectory as dashes: every second segment.
fn dashes(trajectory: &Trajectory, height_m: f64) -> Vec<Vec<[f32; 3]>> {
    points(trajectory, height_m).chunks_exact(2).map(<[_]>::to_vec).collect()
}

/// The frame of a vehicle in the world.
fn pose(state: &State) -> Transform3D {
    Transform3D::update_fields().with_translation(point(state, 0.0)).with_mat3x3(rotation(state.heading_rad))
}

/// An ellipse around the origin, by its half axes \[m\].
fn ellipse([along_m, across_m]: [f64; 2], height_m: f64) -> Vec<[f32; 3]> {
    let at = |index: u16| {
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(index) / f64::from(ELLIPSE_POINTS));
        [(along_m * cos) as f32, (across_m * sin) as f32, height_m as f32]
    };
    (0..=ELLIPSE_POINTS).map(at).collect()
}
