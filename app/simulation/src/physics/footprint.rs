//! Footprints as Parry's shapes: boxes around the bodies, and the distance between two of them.
//!
//! Motion of vehicles within a tick, and the next time at which two of them can touch.
//!
//! Every component of a state changes linearly from its value at the beginning of the tick to that at its end. Over the whole
//! tick, two points of two vehicles approach by at most `‖Δp_a − Δp_b‖ + |Δθ_a| r_a + |Δθ_b| r_b`, with the
//! displacements `Δp` of the mass centres, the rotations `Δθ` and the distances `r` of the farthest corners. So two
//! vehicles that are `gap` apart cannot touch before the share `gap / approach` of a tick has passed. Checking again at that
//! time (conservative advancement) finds, at any speed, every contact that is longer than the shortest step.

use interplay_planners::{Body, State};
use interplay_scenarios::Outline;
use rapier2d::prelude::{Pose, SharedShape, Vector};

/// The outline of a vehicle or an obstacle: a shape, and its pose relative to the mass centre.
#[derive(Clone)]
pub(super) struct Footprint {
    pub shape: SharedShape,
    /// Its pose relative to the mass centre.
    pub centre: Pose,
    /// Distance from the mass centre to the farthest point \[m\].
    pub radius_m: f64,
    /// Front, rear and half of the width of a box, from the mass centre \[m\]; none for another outline.
    pub box_m: Option<[f64; 3]>,
}

impl Footprint {
    /// The box around a body, or the outline of an obstacle that has one.
    pub fn new(body: &Body, outline: Option<&Outline>) -> Footprint {
        let exact = outline.and_then(|outline| match outline {
            Outline::Box { .. } => None,
            Outline::Circle { radius_m } => Some((SharedShape::ball(*radius_m as f32), *radius_m)),
            Outline::Polygon { corners_m } => {
                let points = corners_m.iter().map(|[x, y]| Vector::new(*x as f32, *y as f32)).collect();
                let radius_m = corners_m.iter().map(|[x, y]| libm::hypot(*x, *y)).fold(0.0, f64::max);
                SharedShape::convex_polyline(points).map(|shape| (shape, radius_m))
            }
        });
        match exact {
            Some((shape, radius_m)) => Footprint { shape, centre: Pose::IDENTITY, radius_m, box_m: None },
            None => Footprint {
                shape: shape(body),
                centre: centre(body),
                radius_m: radius_m(body),
                box_m: Some([body.front_m, body.rear_m, 0.5 * body.width_m]),
            },
        }
    }
}

impl std::fmt::Debug for Footprint {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "Footprint(radius {} m)", self.radius_m)
    }
}

/// Distance between the boxes around two bodies; 0 where they touch or overlap \[m\].
pub fn gap_m(a: (&Body, &State), b: (&Body, &State)) -> f64 {
    let [first, second] = [a.0, b.0].map(|body| Footprint::new(body, None));
    distance_m((&first, a.1), (&second, b.1))
}

/// Distance between two footprints; 0 where they touch or overlap \[m\].
pub(super) fn distance_m(a: (&Footprint, &State), b: (&Footprint, &State)) -> f64 {
    let origin = a.1.position();
    let place = |(footprint, state): (&Footprint, &State)| pose(state, origin) * footprint.centre;
    let outcome = parry2d::query::distance(&place(a), &*a.0.shape, &place(b), &*b.0.shape);
    outcome.map_or(f64::INFINITY, |found| f64::from(found.distance))
}

/// A lower bound of the distance between two footprints: that of their circles, and of boxes the largest that separates them along one of
/// their axes; negative where neither does \[m\].
pub(super) fn separation_m(a: (&Footprint, &State), b: (&Footprint, &State)) -> f64 {
    let [dx, dy] = [b.1.x_m - a.1.x_m, b.1.y_m - a.1.y_m];
    let circles_m = (dx * dx + dy * dy).sqrt() - a.0.radius_m - b.0.radius_m;
    let (Some(own), Some(their)) = (a.0.box_m, b.0.box_m) else { return circles_m };
    let axes = [a.1.heading_rad, b.1.heading_rad].map(libm::sincos);
    let turned = axes[0].1 * axes[1].1 + axes[0].0 * axes[1].0;
    let crossed = axes[0].1 * axes[1].0 - axes[0].0 * axes[1].1;
    // Each pair of coordinates is in the frame of one box, in which the other is turned.
    let beside = |(sin, cos): (f64, f64), [dx, dy]: [f64; 2], own: [f64; 3], their: [f64; 3], crossed: f64| {
        let [ahead_m, aside_m] = [cos * dx + sin * dy, cos * dy - sin * dx];
        let [front_m, rear_m, half_m] = their;
        let reach = |along: f64, across: f64| {
            let across_m = half_m * across.abs();
            [(front_m * along).min(-rear_m * along) - across_m, (front_m * along).max(-rear_m * along) + across_m]
        };
        let [low_m, high_m] = reach(turned, crossed).map(|reach_m| ahead_m + reach_m);
        let [right_m, left_m] = reach(crossed, turned).map(|reach_m| aside_m + reach_m);
        (low_m - own[0]).max(-own[1] - high_m).max(right_m - own[2]).max(-own[2] - left_m)
    };
    let of_a_m = beside(axes[0], [dx, dy], own, their, crossed);
    circles_m.max(of_a_m).max(beside(axes[1], [-dx, -dy], their, own, -crossed))
}

/// Length of a footprint \[m\].
pub(super) fn length_m(body: &Body) -> f64 {
    body.front_m + body.rear_m
}

/// Distance from the mass centre to the farthest corner \[m\].
pub(crate) fn radius_m(body: &Body) -> f64 {
    let (ahead, aside) = (body.front_m.max(body.rear_m), 0.5 * body.width_m);
    (ahead * ahead + aside * aside).sqrt()
}

/// The box, centred at its middle.
pub(super) fn shape(body: &Body) -> SharedShape {
    SharedShape::cuboid((0.5 * length_m(body)) as f32, (0.5 * body.width_m) as f32)
}

/// The centre of the box relative to the mass centre.
pub(super) fn centre(body: &Body) -> Pose {
    Pose::new(Vector::new((0.5 * (body.front_m - body.rear_m)) as f32, 0.0), 0.0)
}

/// A state in single precision, relative to an origin.
pub(super) fn pose(state: &State, origin: [f64; 2]) -> Pose {
    let position = Vector::new((state.x_m - origin[0]) as f32, (state.y_m - origin[1]) as f32);
    Pose::new(position, state.heading_rad as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x_m: f64, y_m: f64, heading_rad: f64) -> State {
        State { x_m, y_m, heading_rad, speed_mps: 1.0 }
    }

    #[test]
    fn gaps_of_boxes_agree_with_closed_forms() {
        let body = Body::default();
        let ahead = gap_m((&body, &at(10.0, 0.2, 0.0)), (&body, &at(11.0, 0.2, 0.0)));
        assert!((ahead - 0.6).abs() < 1e-5, "{ahead}");
        let beside = gap_m((&body, &at(10.0, 0.2, 0.0)), (&body, &at(10.1, 0.5, 0.0)));
        assert!((beside - 0.11).abs() < 1e-5, "{beside}");
        let quarter = std::f64::consts::FRAC_PI_2;
        let crossing = gap_m((&body, &at(0.0, 0.0, 0.0)), (&body, &at(1.0, -0.01, quarter)));
        assert!((crossing - (1.0 - 0.21 - 0.095)).abs() < 1e-5, "{crossing}");
        assert_eq!(gap_m((&body, &at(0.0, 0.0, 0.3)), (&body, &at(0.1, 0.05, 0.0))), 0.0);
    }

    /// The separation never exceeds Parry's distance, and is not positive only for boxes that overlap or nearly do.
    #[test]
    fn the_separation_is_a_lower_bound_of_the_distance() {
        let body = Body { front_m: 0.25, ..Body::default() };
        let footprint = Footprint::new(&body, None);
        let mut apart = 0;
        for case in 0..2000 {
            let share = |prime: usize| (case * prime % 1999) as f64 / 1999.0;
            let a = at(0.3 * share(13), 0.3 * share(29), 6.3 * share(41));
            let b = at(1.2 * share(53) - 0.6, 1.2 * share(67) - 0.6, 6.3 * share(71));
            let bound_m = separation_m((&footprint, &a), (&footprint, &b));
            let exact_m = distance_m((&footprint, &a), (&footprint, &b));
            assert!(bound_m <= exact_m + 1e-6, "{a:?} {b:?}: {bound_m} {exact_m}");
            assert!(
                exact_m == 0.0 || bound_m > -1e-6,
                "boxes that are apart are separated by an axis: {bound_m} {exact_m}"
            );
            apart += usize::from(exact_m > 0.0);
        }
        assert!((200..1800).contains(&apart), "{apart}");
    }
}
