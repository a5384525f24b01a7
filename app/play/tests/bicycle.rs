//! The reference values for the bicycle model of the page (`node --test tests/browser/play_parts.mjs`) are those of the Rust model.

use std::path::Path;
use std::{env, fs};

use interplay_planners::traffic::applied_input;
use interplay_planners::{Bicycle, Body, Input, Limits, State};
use serde_json::{Value as Json, json};

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/browser/bicycle_cases.json");
const STEPS: usize = 20;

/// A motion of a body from a state, with inputs of which some are beyond the limits.
fn case(scale: f64, speed_mps: f64, turn: f64) -> Json {
    let small = Body::default();
    let body = Body {
        front_m: scale * small.front_m,
        rear_m: scale * small.rear_m,
        width_m: scale * small.width_m,
        front_axle_m: scale * small.front_axle_m,
        rear_axle_m: scale * small.rear_axle_m,
        scale,
    };
    let (limits, step_s) = (Limits::default(), 0.1);
    let start = State { x_m: 1.0, y_m: -2.0, heading_rad: 0.3, speed_mps };
    let model = Bicycle::new(&body, step_s);
    let (mut state, mut inputs, mut states) = (start, Vec::new(), Vec::new());
    for step in 0..STEPS {
        let wave = libm::sin(0.7 * step as f64);
        let input = Input { acceleration_mps2: 1.5 * wave, steering_rad: turn * libm::cos(0.3 * step as f64) };
        state = model.step(&state, &applied_input(&input, &state, &body, &limits, step_s));
        inputs.push(input.to_array());
        states.push(state.to_array());
    }
    json!({ "body": body, "limits": limits, "step_s": step_s, "state": start.to_array(), "inputs": inputs, "states": states })
}

#[test]
fn the_reference_values_of_the_page_equal_the_rust_model() {
    let cases = json!([case(1.0, 1.0, 0.2), case(1.0, 0.05, -0.6), case(10.0, 1.4, 0.4)]);
    if env::var_os("INTERPLAY_BLESS").is_some() {
        let text = serde_json::to_string_pretty(&cases).expect("JSON") + "\n";
        fs::write(FILE, text).expect("the folder of the browser's tests");
    }
    let text = fs::read_to_string(Path::new(FILE)).expect("INTERPLAY_BLESS=1 makes it");
    let kept: Json = serde_json::from_str(&text).expect("JSON");
    assert_eq!(kept, cases);
}
