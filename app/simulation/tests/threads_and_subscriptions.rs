//! A run has the same bits with any number of threads, and with any subscriptions.

use std::fmt::Write;

use interplay_scenarios::{Scenario, from_text, load};
use interplay_simulation::Simulation;
use interplay_simulation::measure::Subscriptions;

/// Cars of some kind in three lanes, 40 m apart in each.
fn motorway(vehicles: usize, kind: &str) -> Scenario {
    let mut text = format!(
        "title = 'Motorway'\nshows = 'Three lanes'\nscale = 'full'\nduration_s = 6.0\n\
         road = {{ kind = 'lanes', lane_count = 3, lane_width_m = 3.5 }}\n\
         defaults = {{ class = 'car', driver = {{ kind = '{kind}' }} }}\nbudget = {{ plans = 1000000, steps = 100000000 }}\n"
    );
    for index in 0..vehicles {
        let (lane, along_m) = (index % 3, -40.0 * (index / 3) as f64 - 13.0 * (index % 3) as f64);
        let speed_mps = 25.0 + 0.8 * ((index * 7) % 5) as f64 - 1.6;
        let start = format!("{{ lane = {lane}, along_m = {along_m:?}, speed_mps = {speed_mps:?} }}");
        writeln!(text, "[[vehicle]]\nname = 'car-{index}'\nstart = {start}\ngoal = {{ lane = {lane} }}")
            .expect("a text");
    }
    from_text("motorway.toml", &text, &[]).expect("a scenario")
}

fn with_threads(scenario: &Scenario, threads: usize) -> Vec<String> {
    let mut simulation = Simulation::builder(scenario).with_threads(threads).build().expect("a world");
    while simulation.step().expect("a step").is_some() {}
    let report = simulation.finish().expect("a report");
    report.phase_digests.by_name().into_iter().map(|(_, digest)| digest.to_owned()).collect()
}

#[test]
fn any_number_of_threads_gives_the_same_bits_of_every_phase() {
    let authored = load("lane-change/cooperative", &[]).expect("authored");
    for scenario in [motorway(40, "idm"), motorway(6, "human"), authored] {
        let alone = with_threads(&scenario, 1);
        for threads in [2, 3, 8] {
            assert_eq!(with_threads(&scenario, threads), alone, "{} on {threads} threads", scenario.title);
        }
    }
}

#[test]
fn a_run_that_measures_less_moves_as_one_that_measures_everything() {
    for scenario in [motorway(30, "idm"), load("crash/side-impact", &[]).expect("authored")] {
        let digests = [Subscriptions::everything(), Subscriptions::only(&["leaves_road"], &[0])].map(|subscriptions| {
            let mut simulation = Simulation::builder(&scenario).subscribed_to(subscriptions).build().expect("a world");
            while simulation.step().expect("a step").is_some() {}
            let report = simulation.finish().expect("a report");
            let measured: Vec<&str> = report.vehicles[0].metrics.0.iter().map(|(metric, _)| metric.name).collect();
            let contacts: Vec<_> = report.collisions.iter().map(|contact| contact.between.clone()).collect();
            ((report.digest, contacts), measured)
        });
        assert_eq!(digests[0].0, digests[1].0, "{}", scenario.title);
        assert_eq!(digests[1].1, ["leaves_road"]);
        assert!(digests[0].1.len() > 10);
    }
}
