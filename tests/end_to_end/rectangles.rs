//! The distance between two rectangles, computed without the physics engine.

use interplay_planners::{Body, State};

pub type Point = [f64; 2];

/// The corners of a footprint, counter-clockwise.
pub fn corners(body: &Body, state: &State) -> [Point; 4] {
    let (sin, cos) = state.heading_rad.sin_cos();
    let half = body.width_m / 2.0;
    let local = [[body.front_m, -half], [body.front_m, half], [-body.rear_m, half], [-body.rear_m, -half]];
    local.map(|[ahead, left]| [state.x_m + cos * ahead - sin * left, state.y_m + sin * ahead + cos * left])
}

fn edges(corners: &[Point; 4]) -> [[Point; 2]; 4] {
    std::array::from_fn(|i| [corners[i], corners[(i + 1) % 4]])
}

/// Twice the signed area of a triangle: positive if `c` is to the left of the line from `a` to `b`.
fn turn([ax, ay]: Point, [bx, by]: Point, [cx, cy]: Point) -> f64 {
    (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
}

fn to_segment(point: Point, [a, b]: [Point; 2]) -> f64 {
    let (along, away) = ([b[0] - a[0], b[1] - a[1]], [point[0] - a[0], point[1] - a[1]]);
    let length_squared = along[0] * along[0] + along[1] * along[1];
    let share = ((away[0] * along[0] + away[1] * along[1]) / length_squared).clamp(0.0, 1.0);
    (away[0] - share * along[0]).hypot(away[1] - share * along[1])
}

/// Distance between two footprints; 0 where they overlap \[m\].
pub fn distance(first: (&Body, &State), second: (&Body, &State)) -> f64 {
    let (a, b) = (corners(first.0, first.1), corners(second.0, second.1));
    let inside = |point: Point, of: &[Point; 4]| edges(of).iter().all(|[from, to]| turn(*from, *to, point) >= 0.0);
    let cross = |[a, b]: [Point; 2], [c, d]: [Point; 2]| {
        turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0
    };
    let overlap = a.iter().any(|point| inside(*point, &b))
        || b.iter().any(|point| inside(*point, &a))
        || edges(&a).iter().any(|one| edges(&b).iter().any(|other| cross(*one, *other)));
    if overlap {
        return 0.0;
    }
    let from_a = a.iter().flat_map(|point| edges(&b).map(|edge| to_segment(*point, edge)));
    let from_b = b.iter().flat_map(|point| edges(&a).map(|edge| to_segment(*point, edge)));
    from_a.chain(from_b).fold(f64::INFINITY, f64::min)
}

#[test]
fn distances_of_rectangles_match_closed_forms() {
    let body = Body::default();
    let at = |x_m: f64, y_m: f64, heading_rad: f64| State { x_m, y_m, heading_rad, speed_mps: 0.0 };
    let far = |a: State, b: State| distance((&body, &a), (&body, &b));
    assert!((far(at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0)) - 0.6).abs() < 1e-12);
    assert!((far(at(0.0, 0.0, 0.0), at(0.0, 1.0, 0.0)) - 0.81).abs() < 1e-12);
    assert!((far(at(0.0, 0.0, 0.0), at(0.7, 0.59, 0.0)) - 0.3f64.hypot(0.4)).abs() < 1e-12);
    assert_eq!(far(at(0.0, 0.0, 0.0), at(0.0, 0.0, 1.0)), 0.0, "crossed without a corner inside");
}
