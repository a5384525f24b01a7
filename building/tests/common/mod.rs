//! Random networks for property tests.

#![allow(dead_code, reason = "every test binary uses a part")]

pub mod exchange;
pub mod house;
pub mod ordinary;
pub mod reference;

use interplay_building::network::{AMBIENT, Network, Wall, Zone};
use proptest::prelude::*;

/// A wall between two of `places` places, of which that number `zones` is outdoors.
fn wall(zones: usize, places: usize) -> impl Strategy<Value = Wall> {
    let place = move |index: usize| if index == zones { AMBIENT.to_owned() } else { format!("z{index}") };
    (0..zones, 1..places, 5.0..200.0, proptest::option::weighted(0.3, 50.0..2000.0)).prop_map(
        move |(one, shift, resistance_k_per_kw, capacity_kj_per_k)| {
            let other = (one + shift) % places;
            Wall { capacity_kj_per_k, ..Wall::new(place(one), place(other), resistance_k_per_kw) }
        },
    )
}

/// Any network: connected or not, with or without a way out, with walls that store heat.
pub fn network(largest: usize) -> impl Strategy<Value = Network> {
    (1..=largest).prop_flat_map(|zones| network_of(zones, zones + 1))
}

/// Any network of at least two zones without walls to the air outside.
pub fn isolated_network(largest: usize) -> impl Strategy<Value = Network> {
    (2..=largest).prop_flat_map(|zones| network_of(zones, zones))
}

fn network_of(zones: usize, places: usize) -> impl Strategy<Value = Network> {
    let capacities = proptest::collection::vec(50.0..5000.0, zones);
    (capacities, proptest::collection::vec(wall(zones, places), 0..3 * zones)).prop_map(|(capacities, walls)| {
        let zone = |(i, capacity_kj_per_k)| Zone { capacity_kj_per_k, ..Zone::named(format!("z{i}")) };
        let zones: Vec<Zone> = capacities.into_iter().enumerate().map(zone).collect();
        Network::new(&zones, &walls).expect("names and quantities are valid by construction")
    })
}

/// Numbers that look random and are the same every time, in ±`scale`.
pub fn numbers(count: usize, scale: f64) -> Vec<f64> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    (0..count)
        .map(|_| {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            scale * (2.0 * (state >> 11) as f64 / (1_u64 << 53) as f64 - 1.0)
        })
        .collect()
}

/// The largest difference of two slices.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).fold(0.0, |largest, (a, b)| f64::max(largest, (a - b).abs()))
}
