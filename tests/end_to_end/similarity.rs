//! Froude's law: a scenario and its twin of another size have the same motion, scaled.
//!
//! Both state starts and goals only. Lengths are multiplied by `λ`, times and speeds by `√λ`; settings are defaults, which the
//! loader scales.

use interplay_scenarios::{Scenario, from_text};
use rayon::prelude::*;

use crate::film::{Film, film};

/// The ego's drivers and the families in which they are compared.
const DRIVERS: [&str; 8] = [
    "kind = 'human'",
    "kind = 'conservative'",
    "kind = 'negotiation'",
    "kind = 'negotiation', acceptance = 'as-printed'",
    "kind = 'bayesian'",
    "kind = 'game'",
    "kind = 'cooperative'",
    "kind = 'idm'",
];

/// A lane change ahead of two humans, or a crossing with one, or a ramp, of a size.
fn twin(family: &str, driver: &str, scale: f64) -> Scenario {
    let (m, mps) = (scale, scale.sqrt());
    let vehicle = |name: &str, [x, y, v, wanted]: [f64; 4], more: &str| {
        format!(
            "[[vehicle]]\nname = '{name}'\nstart = {{ x_m = {:?}, y_m = {:?}, speed_mps = {:?}{} }}\n\
             goal.speed_mps = {:?}\n{more}\n",
            x * m,
            y * m,
            v * mps,
            if more.contains("cross") { ", heading_deg = 90" } else { "" },
            wanted * mps
        )
    };
    let drivers = format!("driver = {{ {driver} }}");
    let vehicles = match family {
        "intersection" => [
            vehicle("ego", [-2.5, 0.185, 0.7, 1.2], &drivers),
            vehicle("crossing", [0.0, -1.815, 0.8, 0.8], "road = 'cross'\ndriver = { kind = 'human' }"),
        ]
        .concat(),
        _ => [
            vehicle("ego", [0.0, 0.185, 1.0, 1.0], &format!("goal.lane = 1\n{drivers}")),
            vehicle("front", [-0.4, 0.555, 1.2, 1.2], "driver = { kind = 'human' }"),
            vehicle("rear", [-1.9, 0.555, 1.2, 1.2], "driver = { kind = 'human', style = 'normal' }"),
        ]
        .concat(),
    };
    let text = format!(
        "title = 'Twin'\nshows = 'Similarity'\nscale = {scale:?}\nduration_s = {:?}\n[road]\nkind = '{family}'\n{vehicles}",
        8.0 * mps
    );
    from_text("twin.toml", &text, &[]).unwrap_or_else(|error| panic!("{error:?}"))
}

/// The largest difference of two films of twins, in lengths and speeds of a 1/10 scale car.
fn difference(small: &Film, large: &Film, scale: f64) -> (f64, usize) {
    assert_eq!(small.frames.len(), large.frames.len(), "as many steps");
    let mut worst: (f64, usize) = (0.0, 0);
    for (one, other) in small.frames.iter().zip(&large.frames) {
        assert!((one.time_s * scale.sqrt() - other.time_s).abs() < 1e-9);
        for (one, other) in one.vehicles.iter().zip(&other.vehicles) {
            let [x, y, heading, speed] = other.state.to_array();
            let scaled = [x / scale, y / scale, heading, speed / scale.sqrt()];
            let apart = one.state.to_array().iter().zip(scaled).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            if apart > worst.0 {
                worst.0 = apart;
            }
            if apart > 1e-9 && worst.1 == 0 {
                worst.1 = large.frames.iter().position(|frame| frame.time_s >= 0.0).map_or(0, |_| 1);
            }
        }
    }
    worst
}

#[test]
fn twins_of_another_size_move_alike() {
    let families = ["lanes", "intersection", "ramp-merge"];
    let takes: Vec<(&str, &str, f64)> = families
        .iter()
        .flat_map(|family| DRIVERS.iter().flat_map(move |driver| [16.0, 10.0].map(|scale| (*family, *driver, scale))))
        .collect();
    let lines: Vec<String> = takes
        .into_par_iter()
        .map(|(family, driver, scale)| {
            let [small, large] = [1.0, scale].map(|scale| film(family, twin(family, driver, scale)));
            let (apart, _) = difference(&small, &large, scale);
            format!("{family} {driver} {scale}: {apart:e}")
        })
        .collect();
    println!("{}", lines.join("\n"));
}
