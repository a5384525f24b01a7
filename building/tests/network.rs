//! Zones and walls: what they become, what is refused, what is remarked upon.

use interplay_building::comfort::Setpoints;
use interplay_building::control::{Controller, Disturbance};
use interplay_building::day::{Surroundings, run_day};
use interplay_building::discretise::Model;
use interplay_building::network::{AMBIENT, Network, NetworkError, Part, PowerLimits, Remark, Wall, Window, Zone};
use interplay_building::occupancy::Occupancy;
use interplay_building::weather::{Climate, Forecast};

fn zones(names: &[&str]) -> Vec<Zone> {
    names.iter().map(|name| Zone::named(*name)).collect()
}

#[test]
fn the_testbed_has_the_parameters_of_the_dissertation() {
    let network = Network::testbed();
    let laplacian = network.laplacian();
    assert_eq!((network.zone_count(), network.node_count()), (4, 4));
    // Rows of R_T = −L sum to minus the conductance to the air outside.
    for row in laplacian.row_iter() {
        assert!((row.sum() - 1.0 / 31.25).abs() < 1e-15);
    }
    assert_eq!(laplacian, laplacian.transpose());
    assert_eq!(network.adjacent_zones(), [(0, 1), (0, 2), (1, 3), (2, 3)]);
    assert_eq!((laplacian[(0, 3)], laplacian[(1, 2)]), (0.0, 0.0));
    assert!(network.remarks().is_empty());
}

#[test]
fn laplacian_products_match_the_matrix() {
    let walls = [
        Wall::new("a", "b", 20.0).with_capacity_kj_per_k(300.0),
        Wall::new("a", "b", 40.0),
        Wall::new("b", AMBIENT, 30.0).with_capacity_kj_per_k(900.0),
        Wall::new(AMBIENT, "a", 25.0),
    ];
    let network = Network::new(&zones(&["a", "b"]), &walls).expect("valid");
    assert_eq!(network.node_count(), 4);
    let x = nalgebra::DVector::from_vec(vec![21.0, 25.0, -3.0, 7.0]);
    let product = network.laplacian() * &x;
    for (one, other) in network.conduct(x.as_slice()).iter().zip(product.iter()) {
        assert!((one - other).abs() < 1e-12);
    }
}

#[test]
fn a_wall_with_capacity_resists_like_one_without_in_the_steady_state() {
    // Steady heat through a single zone: T − T₀ = R u, however the wall stores heat.
    for capacity_kj_per_k in [None, Some(500.0)] {
        let wall = Wall { capacity_kj_per_k, ..Wall::new("a", AMBIENT, 31.25) };
        let network = Network::new(&zones(&["a"]), &[wall]).expect("valid");
        let mut heat_kw = vec![0.0; network.node_count()];
        heat_kw[0] = 0.4;
        let risen_k =
            network.laplacian().lu().solve(&nalgebra::DVector::from_vec(heat_kw)).expect("heat has a way out");
        assert!((risen_k[0] - 12.5).abs() < 1e-12);
    }
}

/// The part and the key that an error names.
fn place(error: &NetworkError) -> (Option<Part>, String) {
    (error.part(), error.key().expect("a key").to_string())
}

#[test]
fn invalid_zones_and_walls_are_refused_with_their_place() {
    let two = zones(&["kitchen", "bath"]);
    let refused = |zones: &[Zone], walls: &[Wall]| Network::new(zones, walls).expect_err("must be refused");

    assert_eq!(refused(&[], &[]), NetworkError::NoZones);
    assert!(matches!(refused(&zones(&["a", ""]), &[]), NetworkError::BadName { zone: 1, .. }));
    assert!(matches!(refused(&zones(&[AMBIENT]), &[]), NetworkError::BadName { zone: 0, .. }));
    let repeated = refused(&zones(&["a", "b", "a"]), &[]);
    assert_eq!(repeated, NetworkError::DuplicateZone { zone: 2, name: "a".to_owned() });

    let unknown = refused(&two, &[Wall::new("bath", AMBIENT, 30.0), Wall::new("kitchn", "bath", 30.0)]);
    assert!(
        matches!(&unknown, NetworkError::UnknownZone { suggestion, .. } if suggestion == "did you mean `kitchen`?")
    );
    assert!(unknown.to_string().starts_with("wall 2 (`kitchn` - `bath`)"), "{unknown}");
    assert_eq!(place(&unknown), (Some(Part::Wall(1)), "between".to_owned()));

    assert!(matches!(refused(&two, &[Wall::new("bath", "bath", 30.0)]), NetworkError::SamePlace { .. }));
    assert!(matches!(refused(&two, &[Wall::new(AMBIENT, AMBIENT, 30.0)]), NetworkError::SamePlace { .. }));

    for value in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-300] {
        let wall = Wall::new("kitchen", "bath", value);
        let in_wall = |key: &str| (Some(Part::Wall(0)), key.to_owned());
        assert_eq!(place(&refused(&two, std::slice::from_ref(&wall))), in_wall("resistance_k_per_kw"));
        let storing = Wall { resistance_k_per_kw: 30.0, ..wall.with_capacity_kj_per_k(value) };
        assert_eq!(place(&refused(&two, &[storing])), in_wall("capacity_kj_per_k"));
        let zone = Zone { capacity_kj_per_k: value, ..Zone::named("a") };
        let second = refused(&[Zone::named("b"), zone], &[]);
        assert_eq!(place(&second), (Some(Part::Zone(1)), "capacity_kj_per_k".to_owned()));
    }
    for limit_kw in [-1.0, f64::NAN, f64::INFINITY] {
        let zone = Zone { limit_kw, ..Zone::named("a") };
        assert_eq!(place(&refused(&[zone], &[])), (Some(Part::Zone(0)), "limit_kw".to_owned()));
        let zone = Zone { solar_aperture_m2: limit_kw, ..Zone::named("a") };
        assert_eq!(place(&refused(&[zone], &[])), (Some(Part::Zone(0)), "solar_aperture_m2".to_owned()));
    }
}

#[test]
fn zones_without_a_connecting_wall_are_allowed_with_a_remark() {
    let walls = [Wall::new("a", "c", 30.0), Wall::new("b", AMBIENT, 30.0)];
    let network = Network::new(&zones(&["a", "b", "c"]), &walls).expect("allowed");
    let remarks = network.remarks();
    assert_eq!(
        remarks,
        [
            Remark::Apart { groups: vec![vec!["a".into(), "c".into()], vec!["b".into()]] },
            Remark::NoWayOut { zones: vec!["a".into(), "c".into()] },
        ]
    );
    assert_eq!(remarks[0].to_string(), "no heat passes between (`a`, `c`) and (`b`)");

    let alone = Network::new(&zones(&["a"]), &[]).expect("allowed");
    assert_eq!(alone.remarks(), [Remark::NoWayOut { zones: vec!["a".into()] }]);
}

#[test]
fn resistances_in_a_wrong_unit_are_remarked_upon() {
    // Table 2.1 read as K/kW: a room would settle in four minutes.
    let walls = [Wall::new("a", "b", 1.0417), Wall::new("a", AMBIENT, 0.5208), Wall::new("b", AMBIENT, 31.25)];
    let network = Network::new(&zones(&["a", "b"]), &walls).expect("valid numbers");
    let remarks = network.remarks();
    assert!(matches!(&remarks[..], [Remark::Fast { zone, .. }] if zone == "a"), "{remarks:?}");
    // Joules where kilojoules belong.
    let heavy = Zone { capacity_kj_per_k: 1e6, ..Zone::named("a") };
    let network = Network::new(&[heavy], &[Wall::new("a", AMBIENT, 31.25)]).expect("valid numbers");
    assert!(matches!(&network.remarks()[..], [Remark::Slow { .. }]));
}

#[test]
fn zones_and_walls_are_read_with_units_in_the_names() {
    #[derive(serde::Deserialize)]
    struct File {
        zone: Vec<Zone>,
        wall: Vec<Wall>,
    }
    let file: File = toml::from_str(
        r#"
        zone = [{ name = "a" }, { name = "b", capacity_kj_per_k = 800.0, limit_kw = 3.0, solar_aperture_m2 = 2.0 }]
        wall = [
            { between = ["a", "b"], resistance_k_per_kw = 62.5 },
            { between = ["b", "ambient"], resistance_k_per_kw = 31.25, capacity_kj_per_k = 400.0 },
        ]
        "#,
    )
    .expect("the documented format");
    let network = Network::new(&file.zone, &file.wall).expect("valid");
    assert_eq!(network.capacities_kj_per_k(), [1000.0, 800.0, 400.0]);
    assert_eq!(*network.limits(), PowerLimits::symmetric(&[2.0, 3.0]));
    assert_eq!(network.solar_gains_kw(500.0), [0.0, 1.0]);
    assert_eq!(network.gain_count(), 2);
    assert!(toml::from_str::<Zone>("name = 'a'\nlimit = 2.0").is_err(), "a key without its unit is unknown");
}

#[test]
fn sun_falls_on_walls_that_store_heat_and_on_no_others() {
    let massless = Wall { solar_aperture_m2: 1.5, ..Wall::new("a", AMBIENT, 8.0) };
    let wall = Wall { mass_position: Some(0.25), ..massless.clone() }.with_capacity_kj_per_k(500.0);
    let error = Network::new(&zones(&["a"]), std::slice::from_ref(&massless)).expect_err("no heat is stored");
    assert_eq!(place(&error), (Some(Part::Wall(0)), "solar_aperture_m2".to_owned()));
    let network = Network::new(&zones(&["a"]), std::slice::from_ref(&wall)).expect("valid");
    assert_eq!((network.gain_count(), network.solar_gains_kw(400.0)), (2, vec![0.0, 0.6]));
    // In a steady state no heat passes between wall and room, and 0.6 kW leave through three quarters of 8 K/kW.
    let mut nodes_c = vec![10.0; 2];
    let model = Model::exact(&network, 900.0).expect("a step");
    for _ in 0..10_000 {
        model.step(&mut nodes_c, &[0.0], 10.0, &network.solar_gains_kw(400.0));
    }
    assert!(nodes_c.iter().all(|node_c| (node_c - 13.6).abs() < 1e-9), "{nodes_c:?}");
}

const STEP_S: f64 = 1800.0;
const STEPS: usize = 48;

/// Two rooms; the sun falls on the floor of the first and warms the air of the second.
fn building() -> Model {
    let zones = [Zone::named("a"), Zone { solar_aperture_m2: 1.0, ..Zone::named("b") }];
    let walls = [
        Wall::new("a", "b", 40.0),
        Wall { solar_aperture_m2: 3.0, ..Wall::new("a", AMBIENT, 30.0).with_capacity_kj_per_k(2500.0) },
        Wall::new("b", AMBIENT, 35.0),
    ];
    Model::euler(&Network::new(&zones, &walls).expect("valid"), STEP_S).expect("stable")
}

#[test]
fn with_an_exact_forecast_sunlit_walls_reach_the_planned_temperatures() {
    let model = building();
    let network = model.network();
    let sun = |t: usize| if (16..36).contains(&t) { 500.0 } else { 0.0 };
    let day = Disturbance {
        ambient_c: (0..STEPS).map(|t| 24.0 + if t < 20 { 0.0 } else { 6.0 }).collect(),
        gains_kw: (0..STEPS).flat_map(|t| network.solar_gains_kw(sun(t))).collect(),
    };
    let setpoints = Setpoints { occupied_c: vec![22.0], ..Setpoints::default() };
    let targets = setpoints.targets(2, STEP_S, STEPS).expect("valid");
    let mut planning = 0;
    for kind in [
        "thermostat",
        "pid",
        "iterative-learning",
        "model-predictive",
        "clairvoyant",
        "iterative",
        "concurrent",
        "distributed",
        "centralised",
    ] {
        let controller: Controller = toml::from_str(&format!("kind = '{kind}'")).expect("a kind");
        let mut sunlit = controller.controller(&model, STEPS).expect("valid");
        let mut nodes_c = vec![26.0; network.node_count()];
        for number in 0..3 {
            let record = run_day(&model, &mut nodes_c, &mut *sunlit, &targets, &day, &day).expect("runs");
            assert_eq!(record.design.fallback, None, "{kind}");
            if number == 2 && controller.plans() {
                planning += 1;
                let planned_c = &record.design.planned_c;
                assert_eq!(planned_c.len(), 2 * STEPS, "{kind}");
                let errors_k = planned_c.iter().zip(&record.temperatures_c).map(|(plan, real)| (plan - real).abs());
                let largest_k = errors_k.fold(0.0_f64, f64::max);
                assert!(largest_k < 1e-6, "{kind}: {largest_k} K");
            }
        }
    }
    assert!(planning >= 4, "{planning} designs plan");
}

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
