//! Simple motions: the representatives of the classes.
//!
//! A vehicle brakes, keeps its speed or accelerates as hard as it can, and steers to its goal's lateral position or keeps its
//! own; or it keeps its speed and passes an ellipse on the left or on the right, where the road is wide enough. Of several
//! deciding vehicles one after the other does each of these while the others go on as planned, brake, or accelerate.

use super::followed_road::FollowedRoad;
use crate::road::centre_line::FrenetExpansion;
use crate::trajectory::iterate::Iterate;
use crate::trajectory::problem::Problem;
use crate::trajectory::terms::Term;
use crate::vehicle::SteeringGeometry;
use crate::{Axes, Input, State};

/// Accelerations as shares of the strongest braking and acceleration.
const ACCELERATION_SHARES: [f64; 4] = [-1.0, -0.5, 0.0, 1.0];
/// What the others do while one vehicle's motions are tried, besides what they plan: brake, keep their speed or accelerate.
const OTHERS_ACCELERATION_SHARES: [f64; 3] = [-1.0, 0.0, 1.0];

/// A goal nearer than this multiple of the wheelbase across the road needs no motion of its own.
const MIN_LATERAL_MOVE_RATIO: f64 = 0.1;
/// A motion beside an ellipse keeps this multiple of its half axis from the centre.
const SIDE_CLEARANCE_RATIO: f64 = 1.05;
/// An ellipse lies along the vehicle's road if the sine of the angle between them is below this.
const MAX_PARALLEL_SIN: f64 = 0.1;

/// A motion of one vehicle: what an iterate says of it.
#[derive(Clone, Default)]
struct Motion {
    inputs: Vec<Input>,
    states: Vec<State>,
    frenet: Vec<FrenetExpansion>,
}

impl Motion {
    /// The motion of a vehicle in an iterate.
    fn of(iterate: &Iterate, vehicle: usize) -> Motion {
        let Iterate { inputs, states, frenet } = iterate;
        Motion { inputs: inputs[vehicle].clone(), states: states[vehicle].clone(), frenet: frenet[vehicle].clone() }
    }
}

/// Calls `visit` with every combination of simple motions. `planned` is the motion that all vehicles plan so far.
pub(super) fn for_each_motion(problem: &Problem, planned: Option<&Iterate>, mut visit: impl FnMut(&Iterate)) {
    let count = problem.participants.len();
    let planned: Vec<Motion> = (0..count).map(|vehicle| planned_motion(problem, planned, vehicle)).collect();
    let mut joint = Iterate {
        inputs: planned.iter().map(|motion| motion.inputs.clone()).collect(),
        states: planned.iter().map(|motion| motion.states.clone()).collect(),
        frenet: planned.iter().map(|motion| motion.frenet.clone()).collect(),
    };
    let set = |joint: &mut Iterate, vehicle: usize, motion: &Motion| {
        joint.inputs[vehicle].clone_from(&motion.inputs);
        joint.states[vehicle].clone_from(&motion.states);
        joint.frenet[vehicle].clone_from(&motion.frenet);
    };
    // Of two, the motions of the first beside those of the second are all that there are.
    let focused = if count > 2 { count } else { 1 };
    for vehicle in 0..focused {
        let own = motions(problem, vehicle);
        for others in std::iter::once(None).chain(OTHERS_ACCELERATION_SHARES.map(Some)).take(if count > 1 {
            1 + OTHERS_ACCELERATION_SHARES.len()
        } else {
            1
        }) {
            for other in (0..count).filter(|other| *other != vehicle) {
                let motion = others.and_then(|share| simple_motion(problem, other, share, false));
                set(&mut joint, other, motion.as_ref().unwrap_or(&planned[other]));
            }
            let with_planned = (others.is_some() && vehicle == 0).then_some(&planned[0]);
            for motion in own.iter().chain(with_planned) {
                set(&mut joint, vehicle, motion);
                if problem.shared_steps > 0 {
                    visit(&problem.start(&joint.inputs));
                } else {
                    visit(&joint);
                }
            }
        }
        set(&mut joint, vehicle, &planned[vehicle]);
    }
}

/// The motion that a vehicle plans so far; without a plan it keeps its speed.
fn planned_motion(problem: &Problem, planned: Option<&Iterate>, vehicle: usize) -> Motion {
    match planned {
        Some(planned) => Motion::of(planned, vehicle),
        None => simple_motion(problem, vehicle, 0.0, false).unwrap_or_else(|| Motion::of(&problem.start(&[]), vehicle)),
    }
}

/// The simple motions of one vehicle.
fn motions(problem: &Problem, vehicle: usize) -> Vec<Motion> {
    let ways = ACCELERATION_SHARES.into_iter().flat_map(|share| [(share, true), (share, false)]);
    let straight = ways.filter_map(|(share, to_goal)| simple_motion(problem, vehicle, share, to_goal));
    let beside = laterals_beside(problem, vehicle);
    straight.chain(beside.into_iter().filter_map(|lateral_m| motion_to(problem, vehicle, 0.0, lateral_m))).collect()
}

/// The lateral positions on either side of the ellipses along the vehicle's road, as far as the road reaches \[m\].
fn laterals_beside(problem: &Problem, vehicle: usize) -> Vec<f64> {
    let Some(road) = FollowedRoad::find(problem, vehicle) else { return Vec::new() };
    let on_road = |lateral_m: &f64| {
        problem.terms.iter().all(|term| match term {
            Term::RoadEdge(edge) if edge.vehicle == vehicle => {
                let half_width_m = 0.5 * edge.body.width_m;
                let [right_m, left_m] = edge.route.edges_before_end_m(road.start_m(problem, vehicle));
                (right_m + half_width_m..=left_m - half_width_m).contains(lateral_m)
            }
            _ => true,
        })
    };
    let half = problem.horizon / 2;
    let ellipses = problem.terms.iter().filter_map(|term| match term {
        Term::KeepOut(keep_out) if keep_out.vehicle == vehicle => {
            Some((&keep_out.ellipses[half], keep_out.centres[half]))
        }
        Term::Separation(separation) if separation.vehicle == vehicle => {
            Some((&separation.ellipses[0], problem.participants[separation.from].start.position()))
        }
        _ => None,
    });
    let sides = ellipses.flat_map(|(ellipse, centre)| {
        let (across, axes) = road.beside(centre, half);
        let axis = axes.components(Axes::along(ellipse.heading_rad()).vector([1.0, 0.0]));
        let offset_m = SIDE_CLEARANCE_RATIO * ellipse.shape().across_m;
        let is_parallel = axis[1].abs() < MAX_PARALLEL_SIN;
        [across - offset_m, across + offset_m].into_iter().filter(move |_| is_parallel)
    });
    sides.filter(on_road).collect()
}

/// A share of the strongest acceleration (of the strongest braking where it is negative) and the lateral position of the goal
/// or of now; nothing for a vehicle without a goal, or where the two positions are the same.
fn simple_motion(problem: &Problem, vehicle: usize, share: f64, to_goal: bool) -> Option<Motion> {
    let participant = &problem.participants[vehicle];
    let road = FollowedRoad::find(problem, vehicle)?;
    let here = road.at(&participant.start, None).across_m;
    let is_far = |wanted: f64| (wanted - here).abs() > MIN_LATERAL_MOVE_RATIO * participant.model.wheelbase_m();
    let wanted = if to_goal { road.wanted_m().filter(|wanted| is_far(*wanted))? } else { here };
    motion_to(problem, vehicle, share, wanted)
}

/// A share of the strongest acceleration, and a lateral position.
fn motion_to(problem: &Problem, vehicle: usize, share: f64, lateral_m: f64) -> Option<Motion> {
    let participant = &problem.participants[vehicle];
    let road = FollowedRoad::find(problem, vehicle)?;
    let geometry = SteeringGeometry {
        rear_axle_m: participant.model.rear_axle_m(),
        wheelbase_m: participant.model.wheelbase_m(),
        steering_max_rad: participant.limits.steering_max_rad,
        time_ratio: participant.model.time_ratio(),
    };
    let limits = &participant.limits;
    let bound = if share < 0.0 { -limits.acceleration_min_mps2 } else { limits.acceleration_max_mps2 };
    let mut motion = Motion::default();
    let mut state = participant.start;
    motion.states.push(state);
    for t in 0..problem.horizon {
        let input = participant.known_inputs.get(t).copied().unwrap_or_else(|| Input {
            acceleration_mps2: participant.reachable_acceleration(t, state.speed_mps, share * bound),
            steering_rad: road.at(&state, motion.frenet.last()).steer(&geometry, &state, lateral_m),
        });
        let next = participant.model.step(&state, &input);
        if let Some(start) = &participant.route_start {
            motion.frenet.push(start.after(motion.frenet.last().unwrap_or(&start.at), &state, &next));
        }
        state = next;
        motion.inputs.push(input);
        motion.states.push(state);
    }
    Some(motion)
}
