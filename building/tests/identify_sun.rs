//! Sun on a mass is told from sun in the air, by the method `state-space`.

use interplay_building::discretise::Model;
use interplay_building::identify::{
    Boundary, Confidence, HiddenTemperature, Hold, Identification, IdentifySettings, MeasuredWall, MeasuredZone,
    Neighbour, Telemetry, identify,
};
use interplay_building::network::{AMBIENT, Network, Wall, Zone};
use interplay_common::random::Random;

const STEP_S: f64 = 900.0;
const CONDUCTANCE: f64 = 0.2;
/// Apertures of air and wall \[m²\]. A quarter of the wall's resistance lies inside, so that three quarters of its sun come in.
const AIR_M2: f64 = 0.6;
const WALL_M2: f64 = 2.4;
const EFFECTIVE_M2: f64 = AIR_M2 + 0.75 * WALL_M2;

/// Two weeks of a house, simulated by the crate's own exact discretisation, which shares no code with the filter.
fn telemetry(wall_m2: f64, seed: u64) -> Telemetry {
    let air_m2 = AIR_M2 + 0.75 * (WALL_M2 - wall_m2);
    let zone = Zone { capacity_kj_per_k: 3000.0, solar_aperture_m2: air_m2, ..Zone::named("house") };
    let wall = Wall {
        mass_position: Some(0.25),
        solar_aperture_m2: wall_m2,
        ..Wall::new("house", AMBIENT, 1.0 / CONDUCTANCE)
    };
    let network = Network::new(&[zone], &[wall.with_capacity_kj_per_k(17_000.0)]).expect("sound");
    let model = Model::exact(&network, STEP_S).expect("sound");
    let mut random = Random::new(seed, 5);
    let (mut state, mut on, mut cloud) = (vec![20.0, 16.0], false, 0.5);
    let rows = 14 * 96;
    let (mut temperature_c, mut power_kw, mut outdoor_c, mut sun) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for row in 0..rows {
        let hour = f64::from(row) * STEP_S / 3600.0;
        on ^= random.chance(STEP_S / 3600.0 / 3.0);
        cloud = f64::clamp(cloud + random.normal(0.0, 0.08), 0.1, 1.0);
        let height = (std::f64::consts::PI * (hour % 24.0 - 7.0) / 10.0).sin();
        sun.push(if (7.0..17.0).contains(&(hour % 24.0)) { 0.4 * cloud * height.max(0.0) } else { 0.0 });
        outdoor_c.push(5.0 + 4.0 * (hour * std::f64::consts::TAU / 24.0).sin() + 3.0 * (hour * 0.061).sin());
        power_kw.push(if on { 5.0 } else { 0.3 });
        let index = power_kw.len() - 1;
        temperature_c.push(state[0] + random.normal(0.0, 0.03));
        let mut gains_kw = network.solar_gains_kw(1000.0 * sun[index]);
        gains_kw[0] += random.normal(0.0, 0.1);
        model.step(&mut state, &[power_kw[index]], outdoor_c[index], &gains_kw);
    }
    Telemetry {
        step_s: STEP_S,
        time_s: (0..rows).map(|row| f64::from(row) * STEP_S).collect(),
        segments: std::iter::once(0..power_kw.len()).collect(),
        left_out_rows: 0,
        zones: vec![MeasuredZone {
            name: "house".into(),
            temperature_c,
            power_kw,
            power_has_unit: true,
            power_hold: Hold::ZeroOrder,
            supply_air: Vec::new(),
            irradiance_kw_per_m2: Some(sun),
            irradiance_hold: Hold::ZeroOrder,
        }],
        boundaries: vec![Boundary { name: "outdoor".into(), temperature_c: outdoor_c, hold: Hold::ZeroOrder }],
        walls: vec![MeasuredWall { zone: 0, other: Neighbour::Boundary(0) }],
    }
}

fn chosen(found: &Identification) -> &str {
    &found.report.models.iter().find(|model| model.chosen).expect("one is chosen").model
}

#[test]
fn sun_on_a_wall_is_identified_and_exported_as_such() {
    let found = identify(&telemetry(WALL_M2, 1), &IdentifySettings::default()).expect("rich data");
    assert_eq!(chosen(&found), "air, wall to outdoor, sun on the wall to outdoor");
    for (name, truth, limit) in [
        ("aperture to the sun", EFFECTIVE_M2, 0.15),
        ("aperture of the wall to outdoor", WALL_M2, 0.3),
        ("conductance to outdoor", CONDUCTANCE, 0.05),
    ] {
        let quantity = found.report.zones[0].physical.iter().find(|it| it.name == name).expect("listed");
        let (low, high) = (quantity.interval.0.expect("bounded"), quantity.interval.1.expect("bounded"));
        assert!(low <= truth && truth <= high, "{name}: {truth} not in {low} to {high}");
        let value = quantity.value.expect("bounded");
        assert!((value / truth - 1.0).abs() < limit, "{name}: {value} for {truth}");
    }
    let network = found.network.expect("kilowatts are known");
    let (air_m2, wall_m2) = (network.zones[0].solar_aperture_m2, network.walls[0].solar_aperture_m2);
    assert!((wall_m2 / WALL_M2 - 1.0).abs() < 0.3, "{wall_m2}");
    let inside = 1.0 - network.walls[0].mass_position.expect("a mass");
    assert!(((air_m2 + inside * wall_m2) / EFFECTIVE_M2 - 1.0).abs() < 0.15, "{air_m2} {wall_m2} {inside}");
}

#[test]
fn no_sun_on_a_wall_is_identified_if_all_sun_reaches_the_air() {
    let found = identify(&telemetry(0.0, 2), &IdentifySettings::default()).expect("rich data");
    assert_eq!(chosen(&found), "air, wall to outdoor");
    let aperture = found.report.zones[0].physical.iter().find(|it| it.name == "aperture to the sun").expect("listed");
    assert_eq!(aperture.verdict.confidence, Confidence::Identified, "{}", aperture.verdict.words);
}

#[test]
fn only_the_stated_kinds_of_hidden_temperatures_are_tried() {
    let settings = IdentifySettings { hidden: vec![HiddenTemperature::Interior], ..IdentifySettings::default() };
    let found = identify(&telemetry(WALL_M2, 3), &settings).expect("rich data");
    // Coloured heat is not a temperature, and is always tried.
    let temperatures = |found: &Identification| -> Vec<String> {
        let models = found.report.models.iter().map(|model| model.model.clone());
        models.filter(|model| !model.contains("coloured heat")).collect()
    };
    let tried = temperatures(&found);
    assert_eq!(tried[..2], ["air alone", "air, interior mass"]);
    assert!(tried.iter().all(|model| !model.contains("wall") && !model.contains("heater")), "{tried:?}");
    let none = IdentifySettings { hidden: Vec::new(), ..IdentifySettings::default() };
    assert_eq!(temperatures(&identify(&telemetry(WALL_M2, 3), &none).expect("rich data")), ["air alone"]);
}
