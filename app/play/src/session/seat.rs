//! A seat: what its person wishes, and what was done.

use interplay_planners::drivers::inputs::{self, WheelHandOver};
use interplay_planners::drivers::lanes::{RoadLanes, towards};
use interplay_planners::{Driver, Input, Scene};
use interplay_simulation::Simulation;

use super::error::SessionError;

/// What a person wishes: keys, a stick or a finger.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wish {
    /// The number of the message that brought it.
    pub seq: u64,
    /// Share of the strongest braking (negative) or acceleration.
    pub acceleration: f64,
    /// Share of the largest steering angle, positive to the left.
    pub steering: f64,
    /// Whether the lane is kept, and steering is a wish to change sideways.
    pub assist: bool,
}

/// With the lane kept, full steering moves the place that is steered to by so many widths of a lane in a second of a real car.
const SIDEWAYS_LANES_PS: f64 = 0.5;

/// A seat with all that was done in it.
#[derive(Clone, Debug)]
pub(super) struct Seat {
    pub vehicle: usize,
    pub name: String,
    pub wish: Wish,
    /// The number of the last wish that was applied.
    pub applied: u64,
    /// Who takes the wheel at the next plan, if anybody does.
    pub handed_to: Option<Option<String>>,
    /// The kind of planner that has the wheel; none while a person has it.
    pub planner: Option<String>,
    /// What was handed in.
    pub record: inputs::Settings,
    /// With the lane kept, where across the route it steers to \[m\].
    place_m: Option<f64>,
}

impl Seat {
    pub fn new(vehicle: usize, name: &str) -> Seat {
        Seat {
            vehicle,
            name: name.to_owned(),
            wish: Wish::default(),
            applied: 0,
            handed_to: None,
            planner: None,
            record: inputs::Settings::default(),
            place_m: None,
        }
    }

    /// Hands over the wheel if that was asked for, and hands in the input of a plan, if a person has it.
    pub fn decide(&mut self, plan: usize, world: &mut Simulation) -> Result<(), SessionError> {
        if let Some(to) = self.handed_to.take().filter(|to| *to != self.planner) {
            world.hand_over(&self.name, to.as_deref().and_then(Driver::of_kind).as_ref())?;
            self.record.hand_overs.push(WheelHandOver { plan: plan as u32, to: to.clone() });
            (self.planner, self.place_m) = (to, None);
        }
        self.applied = self.wish.seq;
        if self.planner.is_some() {
            return Ok(());
        }
        let scene = world.observe(&self.name)?.scene;
        let input = self.input(&scene);
        world.apply(&self.name, input)?;
        let before = self.record.at(plan);
        // The row that holds may be one of before the wheel was handed over.
        if self.record.inputs.is_empty() || before.to_array().map(f64::to_bits) != input.to_array().map(f64::to_bits) {
            let [acceleration, steering] = input.to_array();
            self.record.inputs.push([plan as f64, acceleration, steering]);
        }
        Ok(())
    }

    /// The input that a wish means.
    fn input(&mut self, scene: &Scene) -> Input {
        let (ego, limits) = (&scene.ego, &scene.ego.limits);
        let share = |wish: f64| if wish.is_finite() { wish.clamp(-1.0, 1.0) } else { 0.0 };
        let [acceleration, steering] = [self.wish.acceleration, self.wish.steering].map(share);
        let acceleration_mps2 = acceleration * limits.strongest_mps2(acceleration);
        if !self.wish.assist {
            self.place_m = None;
            let most_rad = limits.steering_max_at_rad(&ego.body, ego.state.speed_mps);
            return Input { acceleration_mps2, steering_rad: steering * most_rad };
        }
        let lanes = RoadLanes::of_road(scene, None);
        let now_m = ego.route.across(ego.state.position());
        let mut place_m = self.place_m.unwrap_or(now_m);
        if steering == 0.0 {
            // Whoever lets go comes to the middle of the lane in which it is.
            place_m = lanes.centre_m(lanes.at(place_m));
        } else {
            let rate_mps = SIDEWAYS_LANES_PS * lanes.width_m() / ego.body.real_ratio().sqrt();
            let [right_m, left_m] = [lanes.centre_m(0), lanes.centre_m(lanes.count() - 1)];
            place_m = (place_m + steering * rate_mps * scene.step_s).max(right_m).min(left_m);
        }
        self.place_m = Some(place_m);
        Input { acceleration_mps2, ..towards(scene, place_m, ego.state.speed_mps) }
    }
}
