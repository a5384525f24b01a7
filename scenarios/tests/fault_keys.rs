//! The key that a fault names.

use interplay_scenarios::from_text;

/// The key of the first fault of a scenario with one more line.
fn key(line: &str) -> Option<String> {
    let text = format!(
        "title = 'a'\nshows = 'b'\nvehicle = [{{ name = 'a', start = {{ x_m = 0, y_m = 0.2, speed_mps = 1 }} }}]\n{line}"
    );
    let error = from_text("keys.toml", &text, &[]).expect_err("a fault");
    error.faults()[0].key().map(str::to_owned)
}

#[test]
fn a_fault_names_the_key_on_its_line() {
    assert_eq!(key("duration_z = 3.0").as_deref(), Some("duration_z"));
    assert_eq!(key("duration_s = 'long'").as_deref(), Some("duration_s"));
    assert_eq!(key("expect = { no_collision = 3 }").as_deref(), Some("no_collision"));
    assert_eq!(key("[road]\nkind = 'lanes'\nlane_count = -1").as_deref(), Some("lane_count"));
}
