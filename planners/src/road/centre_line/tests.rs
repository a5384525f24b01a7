//! Centre lines against closed forms that stand in books.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use proptest::prelude::*;

use super::segment::Segment;
use super::*;
use crate::Corridor;

fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    libm::hypot(a[0] - b[0], a[1] - b[1])
}

fn line(pieces: &[Piece]) -> CentreLine {
    CentreLine::from_pieces([0.0, 0.0], 0.0, pieces).expect("sound pieces")
}

/// A circle of this curvature that begins in the origin along x.
fn circle(curvature_1pm: f64) -> CentreLine {
    line(&[Piece::Arc { length_m: TAU / curvature_1pm.abs(), curvature_1pm }])
}

/// A straight piece, a left curve and a right curve with clothoids between them.
fn winding() -> CentreLine {
    let pieces = [
        Piece::Straight { length_m: 30.0 },
        Piece::Arc { length_m: 40.0, curvature_1pm: 0.05 },
        Piece::Arc { length_m: 50.0, curvature_1pm: -0.08 },
        Piece::Straight { length_m: 20.0 },
    ];
    line(&smooth(&pieces, 12.0).expect("the pieces are long enough"))
}

/// A straight entry, once around a circle of 15 m radius, and on: the line crosses itself.
fn loop_road() -> CentreLine {
    let pieces = [
        Piece::Straight { length_m: 40.0 },
        Piece::Arc { length_m: 15.0 * TAU, curvature_1pm: 1.0 / 15.0 },
        Piece::Straight { length_m: 40.0 },
    ];
    line(&smooth(&pieces, 10.0).expect("the pieces are long enough"))
}

#[test]
fn a_circular_centre_line_matches_its_closed_form() {
    for curvature_1pm in [0.05, -0.2, 2.0] {
        let (circle, radius) = (circle(curvature_1pm), 1.0 / curvature_1pm);
        assert!((circle.length_m() - TAU * radius.abs()).abs() < 1e-12 * radius.abs());
        for step in 0..=100 {
            let along_m = circle.length_m() * f64::from(step) / 100.0;
            let (sin, cos) = libm::sincos(along_m * curvature_1pm);
            let point = circle.at(along_m);
            assert!(apart(point.position, [radius * sin, radius * (1.0 - cos)]) < 1e-8 * radius.abs());
            assert!((point.heading_rad - along_m * curvature_1pm).abs() < 1e-8);
            assert!((point.curvature_1pm * radius - 1.0).abs() < 2e-6, "{}", point.curvature_1pm * radius - 1.0);
            let across_m = 0.4 * radius.abs();
            let beside = [radius * sin - across_m * sin, radius * (1.0 - cos) + across_m * cos];
            let found = circle.project(beside, Some(along_m + 0.1 * radius.abs()));
            assert!((found.along_m - along_m).abs() < 1e-7 * radius.abs(), "{} {along_m}", found.along_m);
            assert!((found.across_m - across_m).abs() < 1e-8 * radius.abs());
        }
    }
}

/// `C(1)` and `S(1)` of the Fresnel integrals with `πt²/2`, Abramowitz and Stegun, table 7.7.
#[test]
fn a_clothoid_ends_at_the_fresnel_integrals() {
    let clothoid = line(&[Piece::Clothoid { length_m: 1.0, from_1pm: 0.0, to_1pm: PI }]);
    let end = clothoid.at(1.0);
    assert!(apart(end.position, [0.779_893_400_376_822_8, 0.438_259_147_390_354_8]) < 1e-14);
    assert!((end.heading_rad - FRAC_PI_2).abs() < 1e-12 && (end.curvature_1pm - PI).abs() < 1e-12);
    assert!((clothoid.at(0.5).curvature_1pm - FRAC_PI_2).abs() < 1e-5);
}

#[test]
fn a_straight_centre_line_equals_the_corridor_bit_for_bit() {
    for heading_rad in [0.0, 0.3, FRAC_PI_2, -2.5] {
        let (line, corridor) =
            (CentreLine::straight(heading_rad), Corridor { heading_rad, right_m: -1.0, left_m: 1.0, end: None });
        for position in [[0.1, 0.7], [-123.456, 7.89], [1e6, -1e-6]] {
            let (point, expansion) = (line.project(position, Some(3.0)), line.expand(position, None));
            let expected = [corridor.along(position), corridor.across(position)].map(f64::to_bits);
            assert_eq!([point.along_m, point.across_m].map(f64::to_bits), expected);
            assert_eq!([expansion.along_m, expansion.across_m].map(f64::to_bits), expected);
            assert_eq!(point.heading_rad, heading_rad);
        }
    }
}

#[test]
fn centre_lines_have_continuous_curvature_and_unit_speed() {
    let points = [[0.0, 0.0], [3.0, 0.5], [12.0, 4.0], [13.0, 6.0], [13.5, 20.0]];
    for line in [winding(), loop_road(), circle(3.0), CentreLine::through(&points).expect("distinct points")] {
        for knot_m in line.knots_m().iter().skip(1).rev().skip(1) {
            let [before, after] = [-1e-9, 1e-9].map(|step_m| line.at(knot_m + step_m));
            assert!((apart(before.position, after.position) - 2e-9).abs() < 1e-13);
            assert!((before.heading_rad - after.heading_rad).abs() < 1e-8);
            assert!((before.curvature_1pm - after.curvature_1pm).abs() < 1e-7);
        }
        let step_m = line.length_m() / 3000.0;
        for step in 0..3000 {
            let here = line.at((f64::from(step) + 0.5) * step_m);
            let [behind, ahead] = [-1e-4, 1e-4].map(|by_m| line.at((f64::from(step) + 0.5) * step_m + by_m));
            // The chord is shorter than the arc by (κ l)²/24 of it.
            let bent = (2e-4 * here.curvature_1pm).powi(2) / 24.0;
            let speed = apart(behind.position, ahead.position) / 2e-4 * (1.0 + bent);
            assert!((speed - 1.0).abs() < 1.1e-8, "{speed}");
        }
    }
}

/// Checks the expansion at a place against central differences.
fn check_expansion(line: &CentreLine, along_m: f64, across_m: f64) {
    let step = 1e-5;
    let position = line.position(along_m, across_m);
    let here = line.expand(position, Some(along_m));
    assert!((here.along_m - along_m).abs() < 1e-9 && (here.across_m - across_m).abs() < 1e-9);
    for axis in 0..2 {
        let [below, above] = [-step, step].map(|by| {
            let mut moved = position;
            moved[axis] += by;
            line.expand(moved, Some(along_m))
        });
        let slope = |below: f64, above: f64| (above - below) / (2.0 * step);
        assert!((slope(below.along_m, above.along_m) - here.along_gradient[axis]).abs() < 1e-8);
        assert!((slope(below.across_m, above.across_m) - here.across_gradient[axis]).abs() < 1e-8);
        for other in 0..2 {
            let along = slope(below.along_gradient[other], above.along_gradient[other]);
            let across = slope(below.across_gradient[other], above.across_gradient[other]);
            assert!((along - here.along_hessian[axis + other]).abs() < 1e-7, "{along} {here:?}");
            assert!((across - here.across_hessian[axis + other]).abs() < 1e-7, "{across} {here:?}");
        }
        let heading = slope(below.heading_rad, above.heading_rad);
        assert!((heading - here.heading_slope_radpm * here.along_gradient[axis]).abs() < 1e-8);
        let bend = slope(below.heading_slope_radpm, above.heading_slope_radpm);
        assert!((bend - here.heading_bend_radpm2 * here.along_gradient[axis]).abs() < 1e-7);
    }
}

#[test]
fn derivatives_agree_with_finite_differences() {
    let points = [[0.0, 0.0], [8.0, 0.5], [19.0, 5.0], [25.0, 14.0]];
    for line in [winding(), CentreLine::through(&points).expect("distinct points"), CentreLine::straight(0.4)] {
        for (along_m, across_m) in [(3.3, 1.0), (11.7, -2.5), (17.3, 4.0), (23.9, -1.0), (-4.0, 2.0)] {
            check_expansion(&line, along_m, across_m);
        }
    }
}

/// Also for polynomials whose speed is far from 1 and not constant.
#[test]
fn derivatives_of_projections_include_the_speed_of_the_curve() {
    let (from, to) = ([[0.0, 0.0], [1.3, 0.0], [0.02, 0.01]], [[11.0, 0.4], [0.8, 0.07], [-0.05, 0.01]]);
    let line = CentreLine::from_segments(vec![Segment::new(10.0, from, to)]).expect("one segment");
    for (along_m, across_m) in [(1.0, 2.0), (4.0, -3.0), (7.5, 1.0), (9.0, 5.0)] {
        check_expansion(&line, along_m, across_m);
    }
}

#[test]
fn with_a_guess_a_projection_stays_on_its_branch_of_a_loop() {
    let line = loop_road();
    // The middles of entry and exit of the circle are the same place; a full turn lies between them.
    let [entry_m, exit_m] = [40.0, 40.0 + 15.0 * TAU];
    assert!(apart(line.at(entry_m).position, line.at(exit_m).position) < 1.0);
    for (begin_m, turns) in [(20.0, 0.0), (exit_m + 2.0, 1.0)] {
        let mut near_m = begin_m;
        for step in 0..40 {
            let along_m = begin_m + 0.5 * f64::from(step);
            let found = line.project(line.position(along_m, 1.5), Some(near_m));
            assert!((found.along_m - along_m).abs() < 1e-9, "{} instead of {along_m}", found.along_m);
            near_m = found.along_m;
        }
        let heading_rad = line.at(begin_m + 15.0 * turns).heading_rad;
        assert!((heading_rad - TAU * turns).abs() < 0.1, "headings go on after a full turn: {heading_rad}");
    }
}

#[test]
fn headings_continue_from_the_start_beyond_a_full_turn() {
    let arc = [Piece::Arc { length_m: 10.0, curvature_1pm: 0.1 }];
    let line = CentreLine::from_pieces([0.0; 2], 3.0 * TAU - 0.5, &arc).expect("an arc");
    let part = line.between(5.0, 10.0).expect("on the line");
    assert!((line.at(0.0).heading_rad - 3.0 * TAU + 0.5).abs() < 1e-12);
    assert!((line.at(10.0).heading_rad - 3.0 * TAU - 0.5).abs() < 1e-9);
    assert!((part.at(5.0).heading_rad - 3.0 * TAU - 0.5).abs() < 1e-9);
}

#[test]
fn a_centre_line_is_straight_beyond_its_ends() {
    let line = line(&[Piece::Arc { length_m: 10.0, curvature_1pm: 0.1 }]);
    let (end, after) = (line.at(10.0), line.at(15.0));
    assert!((apart(end.position, after.position) - 5.0).abs() < 1e-7);
    assert_eq!((after.curvature_1pm, after.heading_rad), (0.0, end.heading_rad));
    let found = line.project(line.position(15.0, -2.0), None);
    assert!((found.along_m - 15.0).abs() < 1e-9 && (found.across_m + 2.0).abs() < 1e-9);
    let found = line.project([-3.0, 1.0], Some(4.0));
    assert!((found.along_m + 3.0).abs() < 1e-9 && (found.across_m - 1.0).abs() < 1e-9);
}

/// On the normal beyond the centre of a quarter of a circle, the distance to the arc has a maximum in its middle: the nearest
/// points are beyond its ends.
#[test]
fn a_projection_beyond_the_centre_of_curvature_leaves_the_local_maximum() {
    let line = line(&[Piece::Arc { length_m: 5.0 * PI, curvature_1pm: 0.1 }]);
    let middle_m = 2.5 * PI;
    for across_m in [10.5, 12.0, 15.0] {
        let position = line.position(middle_m, across_m);
        let nearest = line.project(position, None);
        let found = line.project(position, Some(middle_m));
        assert!(found.across_m.abs() < across_m - 1e-3, "{found:?}");
        assert!((found.across_m.abs() - nearest.across_m.abs()).abs() < 1e-9, "both ends are equally near");
        let [gx, gy] = line.expand(position, Some(middle_m)).along_gradient;
        assert!(gx.is_finite() && gy.is_finite());
    }
    // Inside of the clamp the derivatives are large and finite.
    let close = line.expand(line.position(middle_m, 9.9), Some(middle_m));
    let slope = libm::hypot(close.along_gradient[0], close.along_gradient[1]);
    assert!((slope * FrenetExpansion::MIN_STRETCH - 1.0).abs() < 1e-6, "{slope}");
}

#[test]
fn projections_of_far_positions_and_guesses_are_finite() {
    let line = loop_road();
    for position in [[1e9, -1e9], [-1e30, 1e20], [40.0, 15.0]] {
        for near_m in [None, Some(-1e30), Some(1e9), Some(f64::NAN), Some(f64::INFINITY)] {
            let (point, expansion) = (line.project(position, near_m), line.expand(position, near_m));
            assert!(point.along_m.is_finite() && point.across_m.is_finite() && point.heading_rad.is_finite());
            let numbers = [expansion.along_gradient, expansion.across_gradient];
            assert!(numbers.iter().flatten().chain(&expansion.along_hessian).all(|number| number.is_finite()));
        }
    }
}

#[test]
fn a_curvature_jump_names_its_piece_and_a_transition_removes_it() {
    let pieces = [Piece::Straight { length_m: 30.0 }, Piece::Arc { length_m: 20.0, curvature_1pm: 0.1 }];
    let jump = CentreLineError::CurvatureJump { piece: 1, from_1pm: 0.0, to_1pm: 0.1 };
    assert_eq!(CentreLine::from_pieces([0.0; 2], 0.0, &pieces), Err(jump));
    let smoothed = smooth(&pieces, 10.0).expect("both are long enough");
    let line = line(&smoothed);
    assert!((line.length_m() - 50.0).abs() < 1e-12 && (line.at(50.0).heading_rad - 2.0).abs() < 1e-12);
    assert!((line.at(30.0).curvature_1pm - 0.05).abs() < 1e-7);
    let short = [pieces[0], Piece::Arc { length_m: 4.0, curvature_1pm: 0.1 }];
    let no_room = CentreLineError::NoRoomForTransition { piece: 1, length_m: 4.0, needed_m: 5.0 };
    assert_eq!(smooth(&short, 10.0), Err(no_room));
}

#[test]
fn invalid_centre_lines_are_refused() {
    let through = |points: &[[f64; 2]]| CentreLine::through(points);
    assert_eq!(through(&[]), Err(CentreLineError::TooFewPoints));
    assert_eq!(through(&[[1.0, 2.0]; 5]), Err(CentreLineError::TooFewPoints));
    assert_eq!(through(&[[1.0, 2.0], [f64::NAN, 0.0]]), Err(CentreLineError::NotFinite { place: "point 1".into() }));
    let turned_back = [[0.0, 0.0], [10.0, 0.0], [0.0, 0.0]];
    assert!(matches!(through(&turned_back), Err(CentreLineError::Cusp { .. })));
    let from = |pieces: &[Piece]| CentreLine::from_pieces([0.0; 2], 0.0, pieces);
    assert_eq!(from(&[]), Err(CentreLineError::NoPieces));
    let none = Piece::Straight { length_m: 0.0 };
    assert_eq!(from(&[none]), Err(CentreLineError::NoLength { piece: 0, length_m: 0.0 }));
    assert!(matches!(
        from(&[Piece::Arc { length_m: 1.0, curvature_1pm: f64::INFINITY }]),
        Err(CentreLineError::NotFinite { .. })
    ));
}

#[test]
fn a_line_through_two_points_is_straight_and_through_a_circle_nearly_circular() {
    let line = CentreLine::through(&[[1.0, 1.0], [4.0, 5.0]]).expect("distinct points");
    assert!((line.length_m() - 5.0).abs() < 1e-14 && apart(line.at(2.5).position, [2.5, 3.0]) < 1e-14);
    let points: Vec<[f64; 2]> =
        (0..=40).map(|i| libm::sincos(0.05 * f64::from(i))).map(|(y, x)| [20.0 * x, 20.0 * y]).collect();
    let line = CentreLine::through(&points).expect("distinct points");
    assert!((line.length_m() - 40.0).abs() < 1e-3);
    assert!((line.at(20.0).curvature_1pm - 0.05).abs() < 1e-4);
    for point in &points {
        assert!(line.project(*point, None).across_m.abs() < 1e-9);
    }
}

#[test]
fn a_line_through_points_has_the_given_headings_at_its_ends() {
    let points: Vec<[f64; 2]> =
        (0..=8).map(|i| libm::sincos(0.2 * f64::from(i))).map(|(y, x)| [20.0 * x, 20.0 * y]).collect();
    let line = CentreLine::through_towards(&points, [Some(FRAC_PI_2), Some(FRAC_PI_2 + 1.6)]).expect("distinct points");
    assert!((line.at(0.0).heading_rad - FRAC_PI_2).abs() < 1e-12);
    assert!((line.at(line.length_m()).heading_rad - FRAC_PI_2 - 1.6).abs() < 1e-12);
    for step in 0..=32 {
        let curvature_1pm = line.at(f64::from(step)).curvature_1pm;
        assert!((curvature_1pm - 0.05).abs() < 5e-4 || step == 32, "{step} {curvature_1pm}");
    }
    let no_heading = CentreLineError::NotFinite { place: "a heading".into() };
    assert_eq!(CentreLine::through_towards(&points, [Some(f64::INFINITY), None]), Err(no_heading));
}

#[test]
fn parallel_sectioned_and_reversed_lines_keep_their_distance() {
    let line = winding();
    let parallel = line.parallel(3.5).expect("it is nowhere that sharp");
    for step in 0..=60 {
        let along_m = parallel.length_m() * f64::from(step) / 60.0;
        let point = parallel.at(along_m);
        let found = line.project(point.position, None);
        assert!((found.across_m - 3.5).abs() < 1e-8 && (found.heading_rad - point.heading_rad).abs() < 1e-7);
        let expected = found.curvature_1pm / (1.0 - found.curvature_1pm * 3.5);
        assert!((point.curvature_1pm - expected).abs() < 1e-6, "{} {expected}", point.curvature_1pm);
    }
    assert!(matches!(line.parallel(25.0), Err(CentreLineError::Cusp { .. })));
    let (part, reversed) = (line.between(17.0, 71.0).expect("on the line"), line.reversed().expect("it has ends"));
    for along_m in [0.0, 13.2, 40.1, 54.0] {
        let (expected, found) = (line.at(17.0 + along_m), part.at(along_m));
        assert!(apart(expected.position, found.position) < 1e-12);
        assert!((expected.curvature_1pm - found.curvature_1pm).abs() < 1e-10);
        let back = reversed.at(line.length_m() - 17.0 - along_m);
        assert!(apart(expected.position, back.position) < 1e-12);
        assert!((expected.curvature_1pm + back.curvature_1pm).abs() < 1e-10);
    }
    assert!(matches!(line.between(20.0, 20.0), Err(CentreLineError::NoSection { .. })));
    assert!(matches!(CentreLine::straight(0.0).parallel(1.0), Err(CentreLineError::NoSection { .. })));
}

#[test]
fn joined_sections_are_one_smooth_line() {
    let (first, second) = (line(&[Piece::Straight { length_m: 20.0 }]), circle(0.1));
    let second = CentreLine::joined(&[LineSection { line: &second, from_m: 0.0, to_m: 10.0 }]).expect("a section").line;
    let moved = CentreLine::from_pieces([20.0, 0.02], 0.01, &[Piece::Arc { length_m: 10.0, curvature_1pm: 0.1 }]);
    assert!((second.length_m() - 10.0).abs() < 1e-12);
    let sections = [
        LineSection { line: &first, from_m: 0.0, to_m: 18.0 },
        LineSection { line: &moved.expect("a sound piece"), from_m: 2.0, to_m: 10.0 },
    ];
    let JoinedLine { line, sections_m } = CentreLine::joined(&sections).expect("they nearly touch");
    assert!((sections_m[0][1] - 18.0).abs() < 1e-12 && (sections_m[1][0] - 22.0).abs() < 0.01);
    for step in 0..299 {
        let [here, ahead] = [0.0, 0.01].map(|by_m| line.at(0.1 * f64::from(step) + by_m));
        assert!((ahead.curvature_1pm - here.curvature_1pm).abs() < 0.005, "no jumps");
        assert!((-0.05..0.2).contains(&here.curvature_1pm), "{}", here.curvature_1pm);
    }
}

proptest! {
    /// A projected point projects onto itself, no nearer point exists, and nothing is ever not a number.
    #[test]
    fn projections_are_nearest_and_idempotent(x in -40.0..150.0_f64, y in -60.0..60.0_f64, near in -20.0..160.0_f64) {
        let line = winding();
        let found = line.project([x, y], None);
        let foot = line.at(found.along_m);
        prop_assert!((apart(foot.position, [x, y]) - found.across_m.abs()).abs() < 1e-7);
        let again = line.project(foot.position, Some(found.along_m));
        prop_assert!((again.along_m - found.along_m).abs() < 1e-9 && again.across_m.abs() < 1e-9);
        for step in 0..=500 {
            let other = line.at(line.length_m() * f64::from(step) / 500.0);
            prop_assert!(apart(other.position, [x, y]) >= found.across_m.abs() - 1e-7);
        }
        let expansion = line.expand([x, y], Some(near));
        let numbers = [expansion.along_m, expansion.across_m, expansion.along_hessian[0], expansion.across_hessian[2]];
        prop_assert!(numbers.iter().all(|number| number.is_finite()));
        // With any guess the offset is perpendicular to the line.
        let foot = line.at(expansion.along_m);
        prop_assert!((apart(foot.position, [x, y]) - expansion.across_m.abs()).abs() < 1e-6);
    }
}

#[test]
fn a_line_rebuilt_from_its_polynomials_is_the_same_line() {
    for line in [winding(), loop_road(), loop_road().between(100.0, 150.0).expect("a part")] {
        let (parts, heading_rad) = (line.polynomials(), line.at(0.0).heading_rad);
        assert_eq!(CentreLine::from_polynomials(&parts, heading_rad), Ok(line.clone()));
        let turned = CentreLine::from_polynomials(&parts, heading_rad + TAU).expect("the same line");
        assert!((turned.at(9.0).heading_rad - line.at(9.0).heading_rad - TAU).abs() < 1e-12);
        assert_eq!(CentreLine::from_polynomials(&parts[..1], f64::NAN).ok(), None);
        let gap = [parts[0], parts[2]];
        assert_eq!(CentreLine::from_polynomials(&gap, heading_rad), Err(CentreLineError::Gap { piece: 1 }));
    }
    assert_eq!(CentreLine::from_polynomials(&[], 0.0), Err(CentreLineError::NoPieces));
}
