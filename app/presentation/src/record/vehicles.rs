//! What moves: bodies with their labels, the paths behind them and the lines ahead of them.

use std::sync::Arc;

use interplay_planners::{Body, PassingOrder, Plan, Route, State, Trajectory};
use interplay_scenarios::Scenario;
use interplay_simulation::frame::{Frame, Origin, VehicleFrame};
use rerun::{RecordingStream, RecordingStreamResult};

use super::palette::{FAILURE, NEUTRAL, NamedColour};
use super::re_sdk_types::archetypes::{Ellipses2D, LineStrips2D, Points2D, Transform3D};
use super::re_sdk_types::components::Radius;
use super::road::turn;

/// The entity whose frame moves along the road with the ego.
pub const FOLLOW: &str = "follow";

/// How many lines fill a body from side to side.
const FILL_LINES: u8 = 7;

/// All vehicles, in the scenario's order.
pub struct VehicleLayer {
    vehicles: Vec<DrawnVehicle>,
    ego: usize,
}

/// One vehicle as it is drawn.
struct DrawnVehicle {
    /// `world/vehicle/<name>`.
    path: String,
    vehicle_colour: NamedColour,
    body: Body,
    route: Arc<Route>,
    last: Option<State>,
    asks: bool,
    /// Whether its last plan had branches.
    branches: bool,
}

impl VehicleLayer {
    /// Logs what never changes about the vehicles: shapes, colours, widths.
    ///
    /// # Errors
    /// If Rerun refuses a component.
    pub fn begin(
        stream: &RecordingStream,
        scenario: &Scenario,
        vehicle_colours: &[NamedColour],
    ) -> RecordingStreamResult<VehicleLayer> {
        let ego = scenario.ego_index();
        let mut vehicles = Vec::new();
        for (vehicle, vehicle_colour) in scenario.vehicles.iter().zip(vehicle_colours) {
            let path = format!("world/vehicle/{}", vehicle.name);
            let route = Arc::clone(&vehicle.route);
            let (vehicle_colour, body) = (*vehicle_colour, vehicle.body);
            let drawn = DrawnVehicle { path, vehicle_colour, body, route, last: None, asks: false, branches: false };
            drawn.log_style(stream)?;
            vehicles.push(drawn);
        }
        if let Some(vehicle) = scenario.ego() {
            let half_axes = [vehicle.safety.along_m as f32, vehicle.safety.across_m as f32];
            for (_, other) in vehicles.iter().enumerate().filter(|(index, _)| *index != ego) {
                let ellipse = Ellipses2D::from_half_sizes([half_axes])
                    .with_colors([NEUTRAL.veiled(90)])
                    .with_line_radii([Radius::new_ui_points(0.8)])
                    .with_draw_order(1.0);
                stream.log_static(format!("{}/safety", other.path), &ellipse)?;
            }
        }
        Ok(VehicleLayer { vehicles, ego })
    }

    /// Logs one tick.
    ///
    /// # Errors
    /// If Rerun refuses a component.
    pub fn tick(&mut self, stream: &RecordingStream, frame: &Frame) -> RecordingStreamResult<()> {
        for (index, (drawn, vehicle)) in self.vehicles.iter_mut().zip(&frame.vehicles).enumerate() {
            drawn.log_tick(stream, vehicle)?;
            let road_point = drawn.route.locate(vehicle.state.position(), None);
            if index == self.ego {
                drawn.log_order(stream, &vehicle.plan)?;
                let [x, y] = drawn.route.centre.position(road_point.along_m, 0.0);
                let here = [x as f32, -y as f32, 0.0];
                stream.log(FOLLOW, &Transform3D::update_fields().with_translation(here))?;
            } else {
                let place = pose(&State { heading_rad: road_point.heading_rad, ..vehicle.state });
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

    fn log_style(&self, stream: &RecordingStream) -> RecordingStreamResult<()> {
        let style = |opacity: u8, points: f32, order: f32| {
            LineStrips2D::update_fields()
                .with_colors([self.vehicle_colour.veiled(opacity)])
                .with_radii([Radius::new_ui_points(points)])
                .with_draw_order(order)
        };
        stream.log_static(self.at("prediction"), &style(130, 1.0, 2.0))?;
        stream.log_static(self.at("trace"), &style(110, 1.5, 3.0))?;
        stream.log_static(self.at("branches"), &style(150, 1.4, 3.5))?;
        let plan = LineStrips2D::update_fields().with_radii([Radius::new_ui_points(1.8)]).with_draw_order(4.0);
        stream.log_static(self.at("plan"), &plan)?;
        let order = Points2D::update_fields().with_colors([self.vehicle_colour.solid()]);
        stream.log_static(self.at("order"), &order.with_radii([Radius::new_ui_points(0.0)]).with_draw_order(8.0))?;
        let dots = Points2D::update_fields().with_colors([self.vehicle_colour.solid()]);
        stream.log_static(self.at("proposal"), &dots.with_radii([Radius::new_ui_points(2.6)]).with_draw_order(5.0))?;
        let (lines, radius) = filling(&self.body);
        let body = LineStrips2D::new(lines).with_radii([radius]).with_colors([self.vehicle_colour.solid()]);
        stream.log_static(self.at("body"), &body.with_draw_order(6.0))?;
        let (ahead, half) = (0.45 * self.body.front_m as f32, 0.36 * self.body.width_m as f32);
        let pane = LineStrips2D::new([[[ahead, -half], [ahead, half]]])
            .with_radii([Radius::new_scene_units(0.12 * self.body.front_m as f32)])
            .with_colors([self.vehicle_colour.dark()])
            .with_draw_order(7.0);
        stream.log_static(self.at("body/windscreen"), &pane)?;
        let label = Points2D::update_fields().with_colors([self.vehicle_colour.solid()]);
        stream.log_static(self.at("label"), &label.with_radii([Radius::new_ui_points(0.0)]).with_draw_order(8.0))
    }

    fn log_tick(&mut self, stream: &RecordingStream, vehicle: &VehicleFrame) -> RecordingStreamResult<()> {
        let state = &vehicle.state;
        stream.log(self.at("body"), &pose(state))?;
        let words = format!("{} {:.2} m/s", vehicle.name, state.speed_mps);
        let below = [state.x_m as f32, (state.y_m - 0.5 * self.body.width_m) as f32];
        let label = Points2D::update_fields().with_positions([below]).with_labels([words]);
        stream.log(self.at("label"), &label)?;
        if let Some(last) = self.last.replace(*state) {
            stream.log(self.at("trace"), &strips([vec![point(&last), point(state)]]))?;
        }
        let plan_colour = if vehicle.origin == Origin::Planned { self.vehicle_colour } else { FAILURE };
        let plan = strips([points(&vehicle.plan.trajectory)]).with_colors([plan_colour.solid()]);
        stream.log(self.at("plan"), &plan)?;
        stream.log(self.at("prediction"), &strips(dashes(&vehicle.prediction)))?;
        let asks = vehicle.plan.proposal.as_ref().map(|proposal| points(&proposal.trajectory));
        if asks.is_some() || self.asks {
            self.asks = asks.is_some();
            let dots = Points2D::update_fields().with_positions(asks.unwrap_or_default());
            stream.log(self.at("proposal"), &dots)?;
        }
        let branches = &vehicle.plan.branches;
        if !branches.is_empty() || self.branches {
            self.branches = !branches.is_empty();
            let lines: Vec<_> = branches.iter().map(|branch| points(&branch.trajectory)).collect();
            stream.log(self.at("branches"), &strips(lines))?;
        }
        Ok(())
    }

    /// Writes the passing orders of a plan at its end.
    fn log_order(&self, stream: &RecordingStream, plan: &Plan) -> RecordingStreamResult<()> {
        let (words, end) = (order_words(plan), plan.trajectory.states.last());
        let (ends, words) = end.filter(|_| !words.is_empty()).map(|end| (point(end), words)).into_iter().unzip();
        let (ends, words): (Vec<[f32; 2]>, Vec<String>) = (ends, words);
        stream.log(self.at("order"), &Points2D::update_fields().with_positions(ends).with_labels(words))
    }
}

/// The passing orders of a plan in words, a line each.
fn order_words(plan: &Plan) -> String {
    plan.passing_orders.iter().map(PassingOrder::to_string).collect::<Vec<_>>().join("\n")
}

fn point(state: &State) -> [f32; 2] {
    [state.x_m as f32, state.y_m as f32]
}

fn points(trajectory: &Trajectory) -> Vec<[f32; 2]> {
    trajectory.states.iter().map(point).collect()
}

fn strips(strips: impl IntoIterator<Item = Vec<[f32; 2]>>) -> LineStrips2D {
    LineStrips2D::update_fields().with_strips(strips)
}

/// Every second step of a motion.
fn dashes(trajectory: &Trajectory) -> Vec<Vec<[f32; 2]>> {
    points(trajectory).chunks_exact(2).map(<[_]>::to_vec).collect()
}

/// The frame of a vehicle in the world.
fn pose(state: &State) -> Transform3D {
    let place = [state.x_m as f32, state.y_m as f32, 0.0];
    Transform3D::update_fields().with_translation(place).with_mat3x3(turn(state.heading_rad))
}

/// Lines, thick enough to cover the body with rounded corners: the viewer has no filled shapes.
fn filling(body: &Body) -> ([Vec<[f32; 2]>; 2], Radius) {
    let radius = body.width_m / (2.0 * f64::from(FILL_LINES));
    let (rear, front) = ((radius - body.rear_m) as f32, (body.front_m - radius) as f32);
    let left = |index: u8| (radius * f64::from(2 * index + 1) - 0.5 * body.width_m) as f32;
    let across = |index: u8| {
        let there = [[rear, left(index)], [front, left(index)]];
        if index.is_multiple_of(2) { there } else { [there[1], there[0]] }
    };
    let (right, last) = (left(0), left(FILL_LINES - 1));
    let outline = vec![[rear, right], [front, right], [front, last], [rear, last], [rear, right]];
    ([outline, (0..FILL_LINES).flat_map(across).collect()], Radius::new_scene_units(1.05 * radius as f32))
}
