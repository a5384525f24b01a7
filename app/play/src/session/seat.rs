//! A seat: the controls of its person, and the record of the inputs.

use interplay_planners::drivers::inputs::{self, WheelHandOver};
use interplay_planners::drivers::lanes::{RoadLanes, towards};
use interplay_planners::{Driver, Input, Scene};
use interplay_simulation::run::RunError;
use interplay_simulation::{NotCopied, Simulation};
use thiserror::Error;

/// The controls of a person: keys, a stick or a finger.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Controls {
    /// The number of the message with these controls.
    pub seq: u64,
    /// Share of the strongest braking (negative) or acceleration.
    pub acceleration: f64,
    /// Share of the largest steering angle, positive to the left.
    pub steering: f64,
    /// Whether the lane is kept automatically; steering then moves the vehicle sideways.
    pub assist: bool,
}

/// With lane keeping, full steering moves the lateral target by this many lane widths per second, for a real car.
const SIDEWAYS_LANES_PS: f64 = 0.5;

/// A seat with the record of its inputs.
#[derive(Clone, Debug)]
pub(super) struct Seat {
    pub vehicle: usize,
    pub name: String,
    pub controls: Controls,
    /// The number of the last applied controls.
    pub applied: u64,
    /// The planner (or `None` for the person) that takes the wheel at the next plan, if a hand-over is pending.
    pub handed_to: Option<Option<String>>,
    /// The kind of planner at the wheel; `None` for the person.
    pub planner: Option<String>,
    pub record: inputs::Settings,
    /// With lane keeping, the lateral target on the route \[m\].
    target_m: Option<f64>,
}

impl Seat {
    pub fn new(vehicle: usize, name: &str) -> Seat {
        Seat {
            vehicle,
            name: name.to_owned(),
            controls: Controls::default(),
            applied: 0,
            handed_to: None,
            planner: None,
            record: inputs::Settings::default(),
            target_m: None,
        }
    }

    /// Makes a pending hand-over, and applies the input of the person, if the person has the wheel.
    pub fn decide(&mut self, plan: usize, world: &mut Simulation) -> Result<(), SessionError> {
        if let Some(to) = self.handed_to.take().filter(|to| *to != self.planner) {
            world.hand_over(&self.name, to.as_deref().and_then(Driver::at_wheel).as_ref())?;
            self.record.hand_overs.push(WheelHandOver { plan: plan as u32, to: to.clone() });
            (self.planner, self.target_m) = (to, None);
        }
        self.applied = self.controls.seq;
        if self.planner.is_some() {
            return Ok(());
        }
        let scene = world.observe(&self.name)?.scene;
        let input = self.input(&scene);
        world.apply(&self.name, input)?;
        let before = self.record.at(plan);
        // The last recorded row may be from before a hand-over.
        if self.record.inputs.is_empty() || before.to_array().map(f64::to_bits) != input.to_array().map(f64::to_bits) {
            let [acceleration, steering] = input.to_array();
            self.record.inputs.push([plan as f64, acceleration, steering]);
        }
        Ok(())
    }

    /// The input that follows from the controls.
    fn input(&mut self, scene: &Scene) -> Input {
        let (ego, limits) = (&scene.ego, &scene.ego.limits);
        let share = |value: f64| if value.is_finite() { value.clamp(-1.0, 1.0) } else { 0.0 };
        let [acceleration, steering] = [self.controls.acceleration, self.controls.steering].map(share);
        let acceleration_mps2 = acceleration * limits.strongest_mps2(acceleration);
        if !self.controls.assist {
            self.target_m = None;
            let most_rad = limits.steering_max_at_rad(&ego.body, ego.state.speed_mps);
            return Input { acceleration_mps2, steering_rad: steering * most_rad };
        }
        let lanes = RoadLanes::of_road(scene, None);
        let now_m = ego.route.across(ego.state.position());
        let mut target_m = self.target_m.unwrap_or(now_m);
        if steering == 0.0 {
            // Without steering, the target is the middle of the present lane.
            target_m = lanes.centre_m(lanes.at(target_m));
        } else {
            let rate_mps = SIDEWAYS_LANES_PS * lanes.width_m() / ego.body.real_ratio().sqrt();
            let [right_m, left_m] = [lanes.centre_m(0), lanes.centre_m(lanes.count() - 1)];
            target_m = (target_m + steering * rate_mps * scene.step_s).max(right_m).min(left_m);
        }
        self.target_m = Some(target_m);
        Input { acceleration_mps2, ..towards(scene, target_m, ego.state.speed_mps) }
    }
}

/// Why a request to a session failed.
#[derive(Debug, Error)]
pub enum SessionError {
    /// The vehicle does not exist, or a person cannot drive it.
    #[error("`{seat}` is not a seat; choose from {seats}")]
    NoSeat {
        seat: String,
        /// The vehicles that a person can drive.
        seats: String,
    },
    /// The scenario has no vehicle for a person.
    #[error("`{0}` has no vehicle that a person can drive; `interplay list` shows all scenarios")]
    NoVehicles(String),
    /// The planner does not exist, or cannot take the wheel.
    #[error("`{0}` is not a planner that can take the wheel")]
    NoPlanner(String),
    /// The simulation failed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The simulation cannot be copied.
    #[error(transparent)]
    NotCopied(#[from] NotCopied),
}
