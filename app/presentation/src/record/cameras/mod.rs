//! The cameras of the views: one from above that follows the interaction, one from the side, and one of the whole road.
//!
//! The scene is three-dimensional. The camera of a view from above is so far away that the projection is nearly orthographic.
//! Labels are marks in the picture of this camera, so that their size does not depend on its distance.
//!
//! ```text
//! world/camera/{top,side}                 a pose at every tick
//! world/camera/top/label/<name>           name and speed, beside the vehicle
//! world/camera/top/collision              names of the colliding vehicles
//! world/camera/whole                      static
//! world/collision                         the star that marks a contact
//! ```

use interplay_planners::State;
use interplay_scenarios::{Scenario, Vehicle};
use interplay_simulation::frame::{Frame, VehicleFrame};
use rerun::{RecordingStream, RecordingStreamResult};

use super::mesh::Mesh;
use super::palette::{FAILURE, NEUTRAL, NamedColour, opaque};
use super::re_sdk_types::archetypes::{Clear, Pinhole, Points2D, Transform3D};
use super::re_sdk_types::components::{Radius, ViewCoordinates};
use super::{Logged, SIM_TIME, TICK, car, labels};
use crate::camera::{self, CameraFrame, CameraView, ViewFormat};
use crate::edge_mark::edge_marks;
use crate::palette::{FLASH, VERMILLION};
use crate::passing_words::{contact_place, star, vehicle_indices};
use crate::rectangle::{Rectangle, extent, rectangle_around};
use crate::shown_extent::labelled;

/// Path of the camera from above.
pub const TOP: &str = "world/camera/top";
/// Path of the camera from the side.
pub const SIDE: &str = "world/camera/side";
/// Path of the camera of the whole road.
pub const WHOLE: &str = "world/camera/whole";

/// The star that marks a contact.
const STAR: &str = "world/collision";

/// Width of the picture from above \[px\]: about as wide as its view in a window of 1280 × 720.
const TOP_WIDTH_PX: f64 = 800.0;
/// Height of this picture, above a picture of the whole road and without one \[px\].
const TOP_HEIGHTS_PX: [f64; 2] = [236.0, 340.0];
/// Least and greatest length of a car \[px\].
const CAR_PX: [f64; 2] = [42.0, 104.0];
/// Least length of a car while a more distant vehicle is mentioned \[px\].
const LEAST_CAR_PX: f64 = 22.0;
/// Heights of the cameras from above, by the width of the visible road: of the view that follows the interaction, and of that of
/// the whole road. From higher up the viewer cannot resolve the heights of objects.
const HEIGHT_RATIO: f64 = 6.0;
const WHOLE_HEIGHT_RATIO: f64 = 2.0;
/// Size of the picture from the side, and its focal length \[px\].
const SIDE_PX: [f64; 2] = [480.0, 360.0];
const SIDE_FOCAL_PX: f64 = 430.0;
/// Distance of this camera from its target, by the width of the view from above; its angle downwards, and its angle to the right
/// of the initial direction of the ego \[rad\].
const SIDE_DISTANCE_RATIO: f64 = 0.62;
const SIDE_PITCH_RAD: f64 = 0.5;
const SIDE_YAW_RAD: f64 = 0.35;
/// Times before and after a contact with a close view, and time that it is marked \[s\], at 1/10 scale.
const CLOSE_UP_S: [f64; 2] = [0.6, 1.6];
const MARKED_S: f64 = 1.6;
/// Size of the star that marks a contact, in lengths of a car.
const STAR_CARS: f64 = 0.35;
/// Width of the picture of the whole road \[px\].
const WHOLE_PX: f64 = 1000.0;
/// Most past frames that the cameras of a live recording keep.
const LIVE_FRAMES: usize = 40;

/// The input of the cameras at a tick.
struct CameraTick {
    tick: i64,
    time_s: f64,
    frame: CameraFrame,
    /// For each vehicle whether it has a label.
    labelled: Vec<bool>,
}

struct Contact {
    time_s: f64,
    between: [usize; 2],
    place_m: [f64; 2],
}

pub struct Cameras {
    format: ViewFormat,
    /// Ticks that have not been logged.
    ticks: Vec<CameraTick>,
    contacts: Vec<Contact>,
    /// The last side of each label; the last entry is that of contacts.
    sides: Vec<usize>,
    time_ratio: f64,
    /// Least and greatest coordinates of all vehicles so far \[m\].
    seen_m: Option<[[f64; 2]; 2]>,
    /// Least and greatest coordinates of the view of the whole road \[m\].
    whole_m: [[f64; 2]; 2],
}

impl Cameras {
    /// Logs the static properties of the cameras. With `has_strip`, the view of the whole road is below the view from above;
    /// `expected_m` are the expected least and greatest coordinates of the vehicles.
    pub fn begin(
        stream: &RecordingStream,
        scenario: &Scenario,
        vehicle_colours: &[NamedColour],
        (has_strip, expected_m): (bool, [[f64; 2]; 2]),
    ) -> RecordingStreamResult<Cameras> {
        let height_px = if has_strip { TOP_HEIGHTS_PX[0] } else { TOP_HEIGHTS_PX[1] };
        let time_ratio = scenario.ego().map_or(1.0, |ego| ego.body.time_ratio());
        let format = ViewFormat {
            width_px: TOP_WIDTH_PX,
            height_px: [height_px; 2],
            straight_height_px: [height_px; 2],
            car_px: CAR_PX,
            least_car_px: LEAST_CAR_PX,
            step_s: scenario.step_s / time_ratio,
        };
        if !scenario.vehicles.is_empty() {
            stream.log_static(TOP, &pinhole(HEIGHT_RATIO * TOP_WIDTH_PX, [TOP_WIDTH_PX, height_px]))?;
            stream.log_static(SIDE, &pinhole(SIDE_FOCAL_PX, SIDE_PX))?;
            stream.log_static(format!("{TOP}/collision"), &label_style(FAILURE))?;
            log_whole(stream, scenario, expected_m)?;
        }
        for (vehicle, vehicle_colour) in scenario.vehicles.iter().zip(vehicle_colours) {
            let style = label_style(*vehicle_colour);
            stream.log_static(format!("{TOP}/label/{}", vehicle.name), &style)?;
        }
        Ok(Cameras {
            format,
            ticks: Vec::new(),
            contacts: Vec::new(),
            sides: vec![0; scenario.vehicles.len() + 1],
            time_ratio,
            seen_m: None,
            whole_m: expected_m,
        })
    }

    /// The size of the picture from above \[px\].
    pub fn top_px(&self) -> [f64; 2] {
        [self.format.width_px, self.format.height_px[1]]
    }

    /// Whether the view of the whole road is below the view from above.
    pub fn has_strip(&self) -> bool {
        self.format.height_px[1] == TOP_HEIGHTS_PX[0]
    }

    /// The size of the picture of the whole road \[px\].
    pub fn whole_px(&self, scenario: &Scenario) -> [f64; 2] {
        let [extent_m, _] = whole(scenario, self.whole_m);
        [WHOLE_PX, WHOLE_PX * extent_m[1] / extent_m[0]]
    }

    /// Stores a tick for [`Cameras::log_all`].
    pub fn store(&mut self, scenario: &Scenario, frame: &Frame) {
        let Some(ego) = frame.vehicles.get(scenario.ego_index()) else { return };
        // The camera must not follow an absent vehicle, so it gets the position of the ego.
        let seen = |vehicle: &VehicleFrame| if vehicle.is_absent { ego.state } else { vehicle.state };
        let states: Vec<State> = frame.vehicles.iter().map(seen).collect();
        for hit in &frame.collisions {
            let Some(between) = vehicle_indices(scenario, &hit.between) else { continue };
            let place = contact_place(scenario, between, between.map(|index| &states[index]));
            self.contacts.extend(place.map(|place_m| Contact { time_s: hit.time_s, between, place_m }));
        }
        self.seen_m = Some(extent(states.iter().map(State::position).chain(self.seen_m.into_iter().flatten())));
        let camera_frame = CameraFrame { states, partners: camera::partners(scenario, ego), close_up: None };
        let tick = i64::try_from(frame.tick).unwrap_or(i64::MAX);
        self.ticks.push(CameraTick {
            tick,
            time_s: frame.time_s,
            frame: camera_frame,
            labelled: labelled(scenario, frame),
        });
    }

    /// Logs all stored ticks. The cameras know the future of the run, so they follow without lag.
    pub fn log_all(&mut self, stream: &RecordingStream, scenario: &Scenario) -> Logged {
        let mut ticks = std::mem::take(&mut self.ticks);
        if ticks.is_empty() {
            return Ok(());
        }
        for tick in &mut ticks {
            tick.frame.close_up = self.close_up(tick.time_s);
        }
        let frames: Vec<CameraFrame> = ticks.iter().map(|tick| tick.frame.clone()).collect();
        let views = camera::views(scenario, &frames, &self.format);
        let yaw_rad = ticks.first().map_or(0.0, |tick| tick.frame.states[scenario.ego_index()].heading_rad);
        for (tick, view) in ticks.iter().zip(&views) {
            stream.set_duration_secs(SIM_TIME, tick.time_s);
            stream.set_time_sequence(TICK, tick.tick);
            self.log(stream, scenario, tick, view, yaw_rad)?;
        }
        self.whole_m = self.seen_m.unwrap_or(self.whole_m);
        log_whole(stream, scenario, self.whole_m)
    }

    /// Logs the last stored tick from past ticks only.
    pub fn log_last(&mut self, stream: &RecordingStream, scenario: &Scenario) -> Logged {
        let first = self.ticks.len().saturating_sub(LIVE_FRAMES);
        self.ticks.drain(..first);
        let frames: Vec<CameraFrame> = self.ticks.iter().map(|tick| tick.frame.clone()).collect();
        let view = camera::views(scenario, &frames, &self.format).pop();
        let Some((tick, view)) = self.ticks.pop().zip(view) else { return Ok(()) };
        let yaw_rad = scenario.ego().map_or(0.0, |ego| ego.start.heading_rad);
        self.log(stream, scenario, &tick, &view, yaw_rad)?;
        self.ticks.push(tick);
        Ok(())
    }

    /// The vehicles in contact that have a close view at a time.
    fn close_up(&self, time_s: f64) -> Option<[usize; 2]> {
        let [before_s, after_s] = CLOSE_UP_S.map(|part| part * self.time_ratio);
        let near = self.contacts.iter().find(|hit| (hit.time_s - before_s..hit.time_s + after_s).contains(&time_s));
        near.map(|hit| hit.between)
    }

    fn log(
        &mut self,
        stream: &RecordingStream,
        scenario: &Scenario,
        tick: &CameraTick,
        view: &CameraView,
        yaw_rad: f64,
    ) -> Logged {
        let extent_m = view.size_px[0] / view.px_per_m;
        stream.log(TOP, &from_above(view.centre_m, HEIGHT_RATIO * extent_m))?;
        // Midway between the centre of the view and the ego, so that the ego is never below the camera.
        let ego = tick.frame.states[scenario.ego_index()].position();
        let target_m = [0, 1].map(|axis| 0.5 * (view.centre_m[axis] + ego[axis]));
        stream.log(SIDE, &from_the_side(target_m, SIDE_DISTANCE_RATIO * extent_m, yaw_rad - SIDE_YAW_RAD))?;
        self.log_labels(stream, scenario, tick, view)?;
        self.log_star(stream, scenario, tick.time_s)
    }

    fn log_labels(
        &mut self,
        stream: &RecordingStream,
        scenario: &Scenario,
        tick: &CameraTick,
        view: &CameraView,
    ) -> Logged {
        let vehicles = scenario.vehicles.iter().zip(&tick.frame.states);
        let mut boxes: Vec<Rectangle> = vehicles
            .clone()
            .map(|(vehicle, state)| rectangle_around(vehicle.body.corners(state).map(|corner| view.place(corner))))
            .collect();
        let label = |((vehicle, state), is_labelled): ((&Vehicle, &State), &bool)| match is_labelled {
            true => format!("{} {:.1} m/s", vehicle.name, state.speed_mps.abs()),
            false => String::new(),
        };
        let mut words: Vec<String> = vehicles.zip(&tick.labelled).map(label).collect();
        let mut paths: Vec<String> =
            scenario.vehicles.iter().map(|vehicle| format!("{TOP}/label/{}", vehicle.name)).collect();
        if let Some(hit) = self.marked_contact(scenario, tick.time_s) {
            let ([x, y], size) = (view.place(hit.place_m), STAR_CARS * camera::car_m(scenario) * view.px_per_m);
            boxes.push([x - size, y - size, x + size, y + size]);
            let [one, other] = hit.between.map(|index| scenario.vehicles[index].name.as_str());
            words.push(format!("{one} and {other} collide"));
        } else {
            boxes.push([f64::NEG_INFINITY; 4]);
            words.push(String::new());
        }
        paths.push(format!("{TOP}/collision"));
        let mut labels = labels::place_labels(&boxes, &words, view.size_px, &mut self.sides);
        for mark in edge_marks(scenario, view, &tick.frame.states, &tick.frame.partners) {
            words[mark.vehicle] = format!("{} {}", mark.words, mark.arrow());
            let taken: Vec<Rectangle> = boxes.iter().copied().chain(labels.iter().flatten().copied()).collect();
            labels[mark.vehicle] = labels::place_edge_label(mark.at, &words[mark.vehicle], view.size_px, &taken);
        }
        for (index, ((path, words), label)) in paths.into_iter().zip(words).zip(labels).enumerate() {
            // The label of contacts, the last one, is logged only in runs with contacts.
            if label.is_some() || index < scenario.vehicles.len() || !self.contacts.is_empty() {
                stream.log(path, &label_at(label, words))?;
            }
        }
        Ok(())
    }

    /// The contact that is marked at a time.
    fn marked_contact(&self, scenario: &Scenario, time_s: f64) -> Option<&Contact> {
        let marked_s = MARKED_S * self.time_ratio;
        self.contacts.iter().find(|hit| (0.0..marked_s).contains(&(time_s - hit.time_s + scenario.step_s)))
    }

    /// Logs the star that marks a contact for a while.
    fn log_star(&self, stream: &RecordingStream, scenario: &Scenario, time_s: f64) -> Logged {
        let Some(hit) = self.marked_contact(scenario, time_s) else {
            return if self.contacts.is_empty() { Ok(()) } else { stream.log(STAR, &Clear::flat()) };
        };
        let car_m = camera::car_m(scenario);
        let height_m = hit.between.map(|index| car::height_m(&scenario.vehicles[index]));
        let mut mesh = Mesh::default();
        for (size, colour, above) in [(STAR_CARS, VERMILLION.rgb, 1.05), (0.6 * STAR_CARS, FLASH, 1.15)] {
            let star = star(hit.place_m, size * car_m);
            mesh.add_polygon(&star, above * height_m[0].max(height_m[1]), colour);
        }
        stream.log(STAR, &mesh.to_component())
    }
}

/// A camera, by its focal length and the size of its picture \[px\].
fn pinhole(focal_px: f64, size_px: [f64; 2]) -> Pinhole {
    let focal_px = focal_px as f32;
    Pinhole::from_focal_length_and_resolution([focal_px, focal_px], size_px.map(|part| part as f32))
        .with_camera_xyz(ViewCoordinates::RDF)
        .with_image_plane_distance(0.0)
        .with_color(opaque(NEUTRAL.rgb))
}

/// The pose of a camera above a place that looks down, with the x axis to the right.
fn from_above([x, y]: [f64; 2], height_m: f64) -> Transform3D {
    Transform3D::update_fields().with_translation([x, y, height_m].map(|part| part as f32)).with_mat3x3([
        [1.0, 0.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, -1.0],
    ])
}

/// The pose of a camera that looks at a place from a distance \[m\], in a horizontal direction \[rad\] and downwards.
fn from_the_side([x, y]: [f64; 2], distance_m: f64, yaw_rad: f64) -> Transform3D {
    let ((sin, cos), (down, level)) = (libm::sincos(yaw_rad), libm::sincos(SIDE_PITCH_RAD));
    let ahead = [level * cos, level * sin, -down];
    let right = [sin, -cos, 0.0];
    let below = [-down * cos, -down * sin, -level];
    let eye = [x - distance_m * ahead[0], y - distance_m * ahead[1], -distance_m * ahead[2]];
    let columns = [right, below, ahead].map(|column| column.map(|part| part as f32));
    Transform3D::update_fields().with_translation(eye.map(|part| part as f32)).with_mat3x3(columns)
}

/// Logs the camera of the whole road, whose picture has the aspect ratio of the road.
fn log_whole(stream: &RecordingStream, scenario: &Scenario, bounds_m: [[f64; 2]; 2]) -> Logged {
    let [extent_m, centre_m] = whole(scenario, bounds_m);
    let px_per_m = WHOLE_PX / extent_m[0];
    let size_px = [WHOLE_PX, px_per_m * extent_m[1]];
    stream.log_static(WHOLE, &pinhole(WHOLE_HEIGHT_RATIO * WHOLE_PX, size_px))?;
    stream.log_static(WHOLE, &from_above(centre_m, WHOLE_HEIGHT_RATIO * extent_m[0]))
}

/// Extent and centre of the view of the whole road \[m\].
fn whole(scenario: &Scenario, [low, high]: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    let margin_m = 2.0 * scenario.road.lane_width_m();
    let extent_m = [0, 1].map(|axis| high[axis] - low[axis] + 2.0 * margin_m);
    [extent_m, [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]))]
}

fn label_style(colour: NamedColour) -> Points2D {
    Points2D::update_fields()
        .with_colors([colour.for_labels()])
        .with_radii([Radius::new_ui_points(0.0)])
        .with_show_labels(true)
        .with_draw_order(10.0)
}

/// A label in a rectangle; the viewer writes the words below a point.
fn label_at(label: Option<Rectangle>, words: String) -> Points2D {
    let point = |[left, top, right, _]: Rectangle| [(0.5 * (left + right)) as f32, (top - 2.0) as f32];
    let (points, words): (Vec<[f32; 2]>, Vec<String>) = label.map(|label| (point(label), words)).into_iter().unzip();
    Points2D::update_fields().with_positions(points).with_labels(words)
}

#[cfg(test)]
mod tests;
