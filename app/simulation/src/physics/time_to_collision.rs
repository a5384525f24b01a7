//! The time until two footprints would touch if both vehicles kept their velocities.

use interplay_planners::{Body, State};
use parry2d::query::{ShapeCastOptions, cast_shapes};
use rapier2d::prelude::Vector;

use super::footprint::{centre, pose, radius_m, shape};

/// A footprint and the velocity of its mass centre.
#[derive(Clone, Copy, Debug)]
pub struct MovingFootprint<'a> {
    /// Body of the vehicle.
    pub body: &'a Body,
    /// Present position, heading and speed.
    pub state: &'a State,
    /// Velocity in world coordinates \[m/s\].
    pub velocity_mps: [f64; 2],
}

/// The time until two footprints would touch at constant velocities and headings \[s\]; 0 if they touch already,
/// `None` if that takes longer than `within_s` or never happens.
///
/// Circles around the footprints decide most pairs; the others are swept by Parry.
pub fn time_to_collision_s(a: &MovingFootprint<'_>, b: &MovingFootprint<'_>, within_s: f64) -> Option<f64> {
    let velocity_mps = [0, 1].map(|axis| b.velocity_mps[axis] - a.velocity_mps[axis]);
    let offset_m = [b.state.x_m - a.state.x_m, b.state.y_m - a.state.y_m];
    if !may_meet(offset_m, velocity_mps, radius_m(a.body) + radius_m(b.body), within_s) {
        return None;
    }
    let origin = a.state.position();
    let place = |one: &MovingFootprint<'_>| pose(one.state, origin) * centre(one.body);
    let velocity = Vector::new(velocity_mps[0] as f32, velocity_mps[1] as f32);
    let options = ShapeCastOptions::with_max_time_of_impact(within_s as f32);
    let (shape_a, shape_b) = (shape(a.body), shape(b.body));
    // Parry supports every pair of boxes.
    let hit = cast_shapes(&place(a), Vector::ZERO, &*shape_a, &place(b), velocity, &*shape_b, options).ok().flatten();
    hit.map(|hit| f64::from(hit.time_of_impact))
}

/// Whether two circles whose radii sum to `radii_m` meet within a time; the second moves relative to the first, and is
/// `offset_m` away from it.
fn may_meet(offset_m: [f64; 2], velocity_mps: [f64; 2], radii_m: f64, within_s: f64) -> bool {
    let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
    let apart_m2 = dot(offset_m, offset_m) - radii_m * radii_m;
    if apart_m2 <= 0.0 {
        return true;
    }
    // |p + w t|² = r² has the roots (c ∓ √(c² − w² (p² − r²)))/w² with c = −p·w.
    let (closing, speed_squared) = (-dot(offset_m, velocity_mps), dot(velocity_mps, velocity_mps));
    let discriminant = closing * closing - speed_squared * apart_m2;
    closing > 0.0 && discriminant >= 0.0 && closing - discriminant.sqrt() <= within_s * speed_squared
}

#[cfg(test)]
mod tests {
    use super::super::footprint::gap_m;
    use super::*;

    fn at(x_m: f64, y_m: f64, heading_rad: f64, speed_mps: f64) -> State {
        State { x_m, y_m, heading_rad, speed_mps }
    }

    fn moving<'a>(body: &'a Body, state: &'a State) -> MovingFootprint<'a> {
        let (sin, cos) = libm::sincos(state.heading_rad);
        MovingFootprint { body, state, velocity_mps: [state.speed_mps * cos, state.speed_mps * sin] }
    }

    fn time_s(a: State, b: State, within_s: f64) -> Option<f64> {
        let body = Body::default();
        let (one, other) = (moving(&body, &a), moving(&body, &b));
        let (there, back) = (time_to_collision_s(&one, &other, within_s), time_to_collision_s(&other, &one, within_s));
        assert!(there.is_some() == back.is_some() && (there.unwrap_or(0.0) - back.unwrap_or(0.0)).abs() < 1e-4);
        there
    }

    #[test]
    fn times_to_collision_agree_with_closed_forms() {
        let is = |found: Option<f64>, wanted_s: f64| {
            let found_s = found.expect("a collision course");
            assert!((found_s - wanted_s).abs() < 1e-4 * (1.0 + wanted_s), "{found_s} {wanted_s}");
        };
        // Bumper to bumper, 1.6 m apart, anywhere in the world.
        for far_m in [0.0, 10_000.0] {
            is(time_s(at(far_m, 0.2, 0.0, 1.5), at(far_m + 2.0, 0.2, 0.0, 0.5), 100.0), 1.6);
            is(time_s(at(far_m, 0.2, 0.0, 1.5), at(far_m + 2.0, 0.2, std::f64::consts::PI, 0.5), 100.0), 0.79);
        }
        // The bumper of one meets the side of the other, which crosses slowly enough.
        let quarter = std::f64::consts::FRAC_PI_2;
        is(time_s(at(0.0, 0.0, 0.0, 1.0), at(2.0, -0.1, quarter, 0.05), 100.0), 2.0 - 0.21 - 0.095);
        is(time_s(at(0.0, 0.0, 0.0, 1.0), at(0.3, 0.0, 0.0, 0.0), 100.0), 0.0);
        assert_eq!(time_s(at(0.0, 0.0, 0.0, 1.0), at(2.0, 0.0, 0.0, 1.1), 100.0), None, "it drives away");
        assert_eq!(time_s(at(0.0, 0.0, 0.0, 1.0), at(2.0, 0.37, 0.0, 0.0), 100.0), None, "it passes beside it");
        assert_eq!(time_s(at(0.0, 0.0, 0.0, 1.0), at(2.0, 0.0, 0.0, 0.0), 1.5), None, "beyond the time limit");
    }

    /// The gap is positive before that time, and zero just after it; without a time it stays positive.
    #[test]
    fn the_gap_closes_at_the_time_to_collision() {
        let body = Body::default();
        let mut met = 0;
        for case in 0..400 {
            let share = |prime: usize| (case * prime % 97) as f64 / 97.0;
            let a = at(0.0, 0.0, 6.0 * share(13), 0.2 + 2.0 * share(29));
            let b = at(3.0 * share(41) - 1.5, 3.0 * share(53) - 1.5, 6.0 * share(67), 2.0 * share(71));
            let moved = |state: State, time_s: f64| {
                let (sin, cos) = libm::sincos(state.heading_rad);
                let far_m = state.speed_mps * time_s;
                State { x_m: state.x_m + far_m * cos, y_m: state.y_m + far_m * sin, ..state }
            };
            let gap_at_m = |time_s: f64| gap_m((&body, &moved(a, time_s)), (&body, &moved(b, time_s)));
            let found = time_s(a, b, 20.0);
            let until_s = found.unwrap_or(20.0);
            for part in 0..if until_s > 0.0 { 200 } else { 0 } {
                let time_s = until_s * part as f64 / 200.0;
                assert!(gap_at_m(time_s) > 0.0, "{a:?} {b:?}: touch at {time_s}, not {found:?}");
            }
            if let Some(found_s) = found {
                assert!(gap_at_m(found_s) < 1e-4, "{a:?} {b:?}: {} m at {found_s}", gap_at_m(found_s));
                met += 1;
            }
        }
        assert!((20..380).contains(&met), "{met} of 400 met");
    }
}
