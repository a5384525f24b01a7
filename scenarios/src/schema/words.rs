//! What editors show beside a key that its description does not say: the unit, and an example where there is no default.

use serde_json::{Value as Json, json};

/// Units of keys whose description states none: table (a definition, or the kind of a tagged table), key, unit. Costs have
/// no unit, so that a weight has the inverse of what it weighs. Whole numbers are counts and need none.
pub(super) const UNITS: &[(&str, &str, &str)] = &[
    ("Weights", "x", "1/m²"),
    ("human", "safety_weight", "dimensionless"),
    ("human", "following_weight", "dimensionless"),
    ("idm", "exponent", "dimensionless"),
    ("negotiation", "beta", "dimensionless"),
    ("negotiation", "gamma", "dimensionless"),
    ("negotiation", "epsilon", "dimensionless"),
    ("negotiation", "ego_normaliser", "dimensionless"),
    ("negotiation", "other_normaliser", "dimensionless"),
    ("negotiation", "weight_floor", "dimensionless"),
    ("bayesian", "w_1_min", "dimensionless"),
    ("bayesian", "w_1_max", "dimensionless"),
    ("bayesian", "w_4", "dimensionless"),
    ("bayesian", "variance_per_change", "dimensionless"),
    ("bayesian", "variance_max", "dimensionless"),
    ("bayesian", "impression_variance", "dimensionless"),
    ("game", "accident", "dimensionless"),
    ("game", "forgetting", "dimensionless"),
    ("game", "epsilon_p", "dimensionless"),
    ("game", "slack_weight", "s/m"),
    ("cooperative", "normaliser", "dimensionless"),
    ("Mobil", "politeness", "dimensionless"),
    ("ProspectTheory", "alpha", "dimensionless"),
    ("ProspectTheory", "beta", "dimensionless"),
    ("ProspectTheory", "lambda", "dimensionless"),
    ("ProspectTheory", "gamma", "dimensionless"),
    ("ProspectTheory", "eta", "dimensionless"),
    ("Climate", "day_correlation", "dimensionless"),
    ("Climate", "storm_probability", "dimensionless"),
    ("Occupancy", "lunch_dip", "dimensionless"),
    ("Deviation", "least_bias", "dimensionless"),
    ("Deviation", "greatest_bias", "dimensionless"),
    ("Deviation", "scatter", "dimensionless"),
    ("Deviation", "meeting_probability", "dimensionless"),
    ("Setpoints", "occupied_weight", "1/K²"),
    ("Setpoints", "other_weight", "1/K²"),
    ("Setpoints", "input_weight", "1/kW²"),
    ("thermostat", "power", "dimensionless"),
    ("iterative", "decay", "dimensionless"),
    ("iterative", "confidence", "dimensionless"),
    ("iterative", "learning_rate", "dimensionless"),
    ("concurrent", "confidence", "dimensionless"),
    ("concurrent", "discomfort_linear", "1/K"),
    ("concurrent", "discomfort_quadratic", "1/K²"),
    ("concurrent", "learning_rate", "dimensionless"),
    ("distributed", "discomfort_quadratic", "1/K²"),
    ("distributed", "learning_rate", "dimensionless"),
    ("distributed", "loss", "dimensionless"),
    ("centralised", "discomfort_quadratic", "1/K²"),
    ("centralised", "learning_rate", "dimensionless"),
    ("UncertaintySettings", "common_correlation", "dimensionless"),
    ("UncertaintySettings", "zone_correlation", "dimensionless"),
    ("UncertaintySettings", "prior_days", "days"),
    ("BuildingExpect", "cost_at_most_share_of_first", "dimensionless"),
    ("BuildingExpect", "regret_at_most", "dimensionless"),
    ("BuildingExpect", "spectral_radius_at_most", "dimensionless"),
    ("BuildingExpect", "above_centralised_at_most", "dimensionless"),
    ("dynamic", "friction", "dimensionless"),
    ("dynamic", "restitution", "dimensionless"),
    ("ModelMismatch", "capacity_factor", "dimensionless"),
    ("ModelMismatch", "inner_resistance_factor", "dimensionless"),
    ("ModelMismatch", "outer_resistance_factor", "dimensionless"),
];

/// Examples for keys without a default: table (nothing for the file itself), key, value.
pub(super) fn examples() -> Vec<Example> {
    [of_a_file(), of_vehicles(), of_buildings(), of_expectations()].concat()
}

type Example = (&'static str, &'static str, Json);

fn of_a_file() -> Vec<Example> {
    vec![
        ("", "title", json!("Lane change, front driver nice")),
        ("", "shows", json!("The ego cuts in ahead of a driver who yields")),
        ("", "figure", json!("6.1")),
        ("", "building", json!({ "preset": "testbed" })),
        ("", "weather", json!({ "kind": "synthetic" })),
        ("", "occupancy", json!({})),
        ("", "setpoints", json!({ "occupied_c": [24.0] })),
        ("", "controller", json!({ "kind": "pid" })),
        ("", "iterations", json!(10)),
    ]
}

fn of_vehicles() -> Vec<Example> {
    vec![
        ("Vehicle", "name", json!("ego")),
        ("Vehicle", "start", json!({ "x_m": 0.0, "y_m": 0.185, "speed_mps": 1.0 })),
        ("State", "x_m", json!(0.0)),
        ("State", "y_m", json!(0.185)),
        ("State", "speed_mps", json!(1.0)),
        ("Goal", "lane", json!(1)),
        ("Goal", "y_m", json!(0.555)),
        ("Goal", "speed_mps", json!(1.0)),
        ("human", "style", json!("nice")),
        ("human", "safety_weight", json!(8.0)),
        ("Order", "from_s", json!(2.0)),
        ("Order", "speed_mps", json!(0.5)),
        ("Order", "acceleration_mps2", json!(-0.5)),
        ("Order", "lateral_m", json!(0.555)),
    ]
}

fn of_buildings() -> Vec<Example> {
    vec![
        ("Building", "preset", json!("testbed")),
        ("Building", "grid", json!({ "rows": 3, "columns": 4 })),
        ("Grid", "rows", json!(3)),
        ("Grid", "columns", json!(4)),
        ("Zone", "name", json!("office")),
        ("Wall", "between", json!(["office", "ambient"])),
        ("Wall", "resistance_k_per_kw", json!(31.25)),
        ("Wall", "capacity_kj_per_k", json!(200.0)),
        ("epw", "file", json!("tropical-july.epw")),
        ("epw", "month", json!(7)),
        ("epw", "day", json!(8)),
        ("uncertain", "level", json!("low")),
        ("Setpoints", "other_c", json!(28.0)),
        ("distributed", "silent_zone", json!(0)),
        ("concurrent", "gamma_2", json!(4.6)),
    ]
}

fn of_expectations() -> Vec<Example> {
    vec![
        ("Expect", "no_collision", json!(true)),
        ("Expect", "order", json!(["ego", "front"])),
        ("Expect", "collisions", json!([["ego", "front"]])),
        ("Expect", "min_gap_m", json!(0.05)),
        ("Expect", "plan_failures_at_most", json!(0)),
        ("Expect", "building", json!({ "after_iterations": 2 })),
        ("Completes", "vehicle", json!("ego")),
        ("Completes", "after_s", json!(1.0)),
        ("Completes", "before_s", json!(6.0)),
        ("SpeedRange", "vehicle", json!("ego")),
        ("SpeedRange", "min_below_mps", json!(0.8)),
        ("SpeedRange", "min_above_mps", json!(0.2)),
        ("SpeedRange", "max_below_mps", json!(1.4)),
        ("SpeedRange", "max_above_mps", json!(1.1)),
        ("BuildingExpect", "cost_never_rises", json!(true)),
        ("BuildingExpect", "cost_at_most_share_of_first", json!(0.5)),
        ("BuildingExpect", "regret_at_most", json!(30.0)),
        ("BuildingExpect", "early_kwh_at_least", json!(1.0)),
        ("BuildingExpect", "spectral_radius_at_most", json!(0.9)),
        ("BuildingExpect", "fallbacks_at_most", json!(0)),
        ("BuildingExpect", "exchange_never_rises", json!(true)),
        ("BuildingExpect", "above_centralised_at_most", json!(0.01)),
        ("BuildingExpect", "tracking_rmse_c_at_most", json!(0.6)),
        ("BuildingExpect", "discomfort_k_h_at_most", json!(1.2)),
        ("BuildingExpect", "energy_kwh_at_most", json!(32.0)),
        ("BuildingExpect", "input_violation_kw_at_most", json!(0.0)),
    ]
}
