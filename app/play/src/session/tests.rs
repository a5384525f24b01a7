//! A played run is saved as a scenario that repeats it.

use interplay_scenarios::{embedded, from_text, load};
use interplay_simulation::run::run;

use super::*;
use interplay_scenarios::Scenario;
use interplay_simulation::frame::Frame;

/// A generator of random numbers from 0 to below `count`.
struct Random(u64);

impl Random {
    fn below(&mut self, count: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % count
    }
}

/// The digests of a played run and of a run of the scenario that it is saved as.
fn digests(session: &Session) -> (String, String) {
    let text = session.played().to_file().to_toml();
    let again = from_text("played.toml", &text, &[]).expect("the played run is a scenario");
    (session.report().digest, run("again", &again, Vec::new()).expect("a run").digest)
}

/// Plays at random, with rewinds and hand-overs, for some ticks.
fn play(scenario: &Scenario, seat: &str, ticks: u64, random: &mut Random) -> Session {
    let mut session = Session::new("played", scenario, &[seat]).expect("a session");
    for _ in 0..ticks {
        match random.below(40) {
            0 => session.rewind(0.1 * random.below(30) as f64).expect("a snapshot"),
            1 => session.hand_over(seat, Some("conservative")).expect("a planner"),
            2 | 3 => session.hand_over(seat, None).expect("the person again"),
            4..12 => {
                let axis = |random: &mut Random| random.below(201) as f64 / 100.0 - 1.0;
                let (acceleration, steering) = (axis(random), 0.3 * axis(random));
                let controls = Controls { seq: 1, acceleration, steering, assist: random.below(2) == 0 };
                session.set_controls(seat, controls).expect("a seat");
            }
            _ => {}
        }
        session.tick().expect("a tick");
    }
    session
}

#[test]
fn a_saved_played_run_repeats_bit_for_bit() {
    let mut random = Random(7);
    for name in ["lane-change/front-nice", "intersection/nice", "ramp-merge/nice", "mixed/garage"] {
        let scenario = load(name, &[]).expect("authored");
        let seats = seats_of(&scenario);
        for play_number in 0..4 {
            let seat = &seats[random.below(seats.len() as u64) as usize];
            let session = play(&scenario, seat, 50, &mut random);
            let (played, repeated) = digests(&session);
            assert_eq!(played, repeated, "{name} as {seat}, play {play_number}");
        }
    }
}

/// The same for every family, many times: `cargo test --release -p interplay-play -- --ignored`.
#[test]
#[ignore = "takes minutes"]
fn two_hundred_plays_of_all_families_are_repeated() {
    let mut random = Random(3);
    let mut families: Vec<Vec<&str>> = Vec::new();
    for file in embedded() {
        let family = file.name.split('/').next();
        match families.last_mut().filter(|last| last[0].split('/').next() == family) {
            Some(last) => last.push(file.name),
            None => families.push(vec![file.name]),
        }
    }
    let mut plays = 0;
    while plays < 200 {
        for family in &families {
            let scenario = load(family[random.below(family.len() as u64) as usize], &[]).expect("authored");
            let seats = seats_of(&scenario);
            if seats.is_empty() {
                continue;
            }
            let seat = &seats[random.below(seats.len() as u64) as usize];
            let ticks = 20 + random.below(60);
            let session = play(&scenario, seat, ticks, &mut random);
            let (played, repeated) = digests(&session);
            assert_eq!(played, repeated, "{} as {seat}, play {plays}", family[0]);
            plays += 1;
        }
    }
}

/// Planners do not know the future inputs of a person: all plans are equal as long as the inputs are.
#[test]
fn plans_do_not_depend_on_future_inputs_of_a_person() {
    const SAME: usize = 20;
    let scenario = load("lane-change/front-nice", &[]).expect("authored");
    let plays = [-1.0, 1.0].map(|later| {
        let mut session = Session::new("played", &scenario, &["front"]).expect("a session");
        let frames = (0..SAME + 10).filter_map(|tick| {
            let acceleration = if tick < SAME { 0.1 } else { later };
            session
                .set_controls("front", Controls { acceleration, assist: true, ..Controls::default() })
                .expect("a seat");
            session.tick().expect("a tick");
            session.frame().cloned()
        });
        frames.collect::<Vec<_>>()
    });
    let plans = |frames: &[Frame], tick: usize| -> Vec<_> {
        frames[tick].vehicles.iter().map(|vehicle| vehicle.plan.trajectory.clone()).collect()
    };
    let is_equal = |tick: usize| {
        let [one, other] = [&plays[0], &plays[1]].map(|frames| plans(frames, tick));
        // The plan of the seat itself differs at the tick of the first different input.
        one.iter().zip(&other).enumerate().all(|(index, (one, other))| index == 1 || one == other)
    };
    assert!((0..=SAME).all(is_equal));
    assert!(!(SAME..SAME + 10).all(is_equal), "plans differ after the inputs do");
}

#[test]
fn only_a_vehicle_with_a_driver_can_be_a_seat() {
    let scenario = load("lane-change/front-nice", &[]).expect("authored");
    let error = Session::new("played", &scenario, &["stranger"]).err().map(|error| error.to_string());
    assert_eq!(error.as_deref(), Some("`stranger` is not a seat; choose from ego, front, rear"));
    let mut session = Session::new("played", &scenario, &["ego"]).expect("a session");
    assert!(session.hand_over("ego", Some("inputs")).is_err());
    assert!(session.set_controls("front", Controls::default()).is_err(), "no person sits in front");
}
