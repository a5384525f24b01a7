//! Windows by the direction that they face, from the weather to the heat of a zone.

use interplay_building::day::Surroundings;
use interplay_building::discretise::Model;
use interplay_building::network::{AMBIENT, Network, Wall, Window, Zone};
use interplay_building::occupancy::Occupancy;
use interplay_building::weather::{Climate, Forecast};

const STEPS: usize = 48;

/// Heat of the sun in the zones and the wall of a network on a day of the synthetic climate \[kWh\].
fn sun_kwh(zones: &[Zone], walls: &[Wall]) -> Vec<f64> {
    let network = Network::new(zones, walls).expect("a network");
    let model = Model::exact(&network, 1800.0).expect("stable");
    let people = Occupancy::default().people(network.zone_count(), 3);
    let surroundings = Surroundings::new(Climate::default().weather(3, 2), (Forecast::Exact, 1), people, &network);
    let steps_kw = surroundings.sun_kw(model.network(), 0.0, 1800.0, STEPS);
    let nodes = network.gain_count();
    let kwh = |node: usize| 0.5 * steps_kw.iter().skip(node).step_by(nodes).sum::<f64>();
    // What the disturbance of the day holds besides people is the same sun.
    let gains_kw = surroundings.actual(&model, STEPS, 0).gains_kw;
    let people_kw = surroundings.people_kw(0, network.zone_count(), 1800.0, STEPS);
    let total_kwh = 0.5 * (gains_kw.iter().sum::<f64>() - people_kw.iter().sum::<f64>());
    let nodes_kwh: Vec<f64> = (0..nodes).map(kwh).collect();
    assert!((total_kwh - nodes_kwh.iter().sum::<f64>()).abs() < 1e-9, "{total_kwh} {nodes_kwh:?}");
    nodes_kwh
}

fn outer(zone: &str) -> Wall {
    Wall::new(zone, AMBIENT, 30.0)
}

#[test]
fn a_flat_window_is_a_horizontal_aperture() {
    let flat = Window { tilt_deg: 0.0, solar_factor: 0.5, ..Window::facing(90.0, 4.0) };
    let zones = [
        Zone { solar_aperture_m2: 2.0, ..Zone::named("aperture") },
        Zone { windows: vec![flat], ..Zone::named("window") },
    ];
    let kwh = sun_kwh(&zones, &[outer("aperture"), outer("window")]);
    // Below 5° the model of the sky takes the sun for higher than it is.
    assert!(kwh[0] > 5.0 && (kwh[1] / kwh[0] - 1.0).abs() < 5e-3, "{kwh:?}");
}

/// At an equinox on the equator the sun goes from east over the zenith to west.
#[test]
fn walls_receive_the_sun_of_the_direction_they_face() {
    let facing =
        |name: &str, facing_deg: f64| Zone { windows: vec![Window::facing(facing_deg, 4.0)], ..Zone::named(name) };
    let zones = [facing("north", 0.0), facing("east", 90.0), facing("south", 180.0), facing("west", 270.0)];
    let walls: Vec<Wall> = zones.iter().map(|zone| outer(&zone.name)).collect();
    let kwh = sun_kwh(&zones, &walls);
    assert!((kwh[0] / kwh[2] - 1.0).abs() < 0.1, "north and south are alike: {kwh:?}");
    assert!(kwh[1].min(kwh[3]) > 1.02 * kwh[0].max(kwh[2]), "{kwh:?}");
    let down = Zone { windows: vec![Window { tilt_deg: 180.0, ..Window::facing(0.0, 4.0) }], ..Zone::named("down") };
    let reflected = sun_kwh(&[down], &[outer("down")])[0];
    let up = Zone { windows: vec![Window { tilt_deg: 0.0, ..Window::facing(0.0, 4.0) }], ..Zone::named("up") };
    let ratio = reflected / sun_kwh(&[up], &[outer("up")])[0];
    assert!((ratio - 0.2).abs() < 1e-3, "what the ground reflects: {ratio}");
}

#[test]
fn sun_through_a_window_may_heat_a_wall_that_stores_heat() {
    let floor = Wall { windows: vec![Window::facing(180.0, 3.0)], ..outer("a").with_capacity_kj_per_k(2000.0) };
    let zones = [Zone { windows: vec![Window::facing(180.0, 1.0)], ..Zone::named("a") }];
    let kwh = sun_kwh(&zones, &[floor]);
    assert!(kwh.len() == 2 && (kwh[1] / kwh[0] - 3.0).abs() < 1e-9, "{kwh:?}");
    let thin = Wall { windows: vec![Window::facing(180.0, 3.0)], ..outer("a") };
    let error = Network::new(&zones, &[thin]).expect_err("stores no heat");
    assert_eq!(error.key().map(|key| key.as_str().to_owned()).as_deref(), Some("window"));
}
