//! A heated house whose wall stores heat, simulated with noise.

use interplay_building::discretise::Model;
use interplay_building::identify::{Boundary, Hold, MeasuredWall, MeasuredZone, Neighbour, Telemetry};
use interplay_building::network::{AMBIENT, Network, Wall, Zone};
use interplay_common::random::Random;

#[derive(Clone, Copy)]
pub struct House {
    pub air_kj_per_k: f64,
    pub wall_kj_per_k: f64,
    /// From the air through the wall outdoors.
    pub conductance_kw_per_k: f64,
    /// Whether heat and weather never change.
    pub is_steady: bool,
}

/// A house with a time constant of 28 h, most of its capacity in the wall.
pub const WALL_HOUSE: House =
    House { air_kj_per_k: 3000.0, wall_kj_per_k: 17_000.0, conductance_kw_per_k: 0.2, is_steady: false };

impl House {
    /// Telemetry of some days: weather that is held over a step, heat switched at random, sensor noise of 0.03 K, random heat.
    pub fn simulate(&self, step_s: f64, days: usize, seed: u64) -> Telemetry {
        let zone = Zone { capacity_kj_per_k: self.air_kj_per_k, ..Zone::named("house") };
        let wall = Wall::new("house", AMBIENT, 1.0 / self.conductance_kw_per_k);
        let wall = Wall { mass_position: Some(0.25), ..wall.with_capacity_kj_per_k(self.wall_kj_per_k) };
        let network = Network::new(&[zone], &[wall]).expect("sound");
        let model = Model::exact(&network, step_s).expect("sound");
        let mut random = Random::new(seed, 5);
        let rows = days * (86_400.0 / step_s) as usize;
        let (mut state, mut on) = (vec![20.0, 16.0], false);
        let (mut temperature_c, mut power_kw, mut outdoor_c) = (Vec::new(), Vec::new(), Vec::new());
        for row in 0..rows {
            let hour = row as f64 * step_s / 3600.0;
            on ^= random.chance(step_s / 3600.0 / 3.0);
            let weather = 4.0 * (hour * std::f64::consts::TAU / 24.0).sin() + 3.0 * (hour * 0.061).sin();
            let outdoor = 5.0 + if self.is_steady { 0.0 } else { weather };
            let heat = if self.is_steady {
                2.5
            } else if on {
                5.0
            } else {
                0.3
            };
            temperature_c.push(state[0] + random.normal(0.0, 0.03));
            power_kw.push(heat);
            outdoor_c.push(outdoor);
            model.step(&mut state, &[heat], outdoor, &[random.normal(0.0, 0.1)]);
        }
        Telemetry {
            step_s,
            time_s: (0..rows).map(|row| row as f64 * step_s).collect(),
            segments: std::iter::once(0..rows).collect(),
            left_out_rows: 0,
            zones: vec![MeasuredZone {
                name: "house".into(),
                temperature_c,
                power_kw,
                power_has_unit: true,
                power_hold: Hold::ZeroOrder,
                supply_air: Vec::new(),
                irradiance_kw_per_m2: None,
                irradiance_hold: Hold::FirstOrder,
            }],
            boundaries: vec![Boundary { name: "outdoor".into(), temperature_c: outdoor_c, hold: Hold::ZeroOrder }],
            walls: vec![MeasuredWall { zone: 0, other: Neighbour::Boundary(0) }],
        }
    }
}
