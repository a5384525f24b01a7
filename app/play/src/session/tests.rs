//! What was played is a scenario that repeats it, whatever was played.

use interplay_scenarios::{embedded, from_text, load};
use interplay_simulation::run::run;

use super::*;
use interplay_scenarios::Scenario;
use interplay_simulation::frame::Frame;

/// Numbers from 0 to below `count` that follow from a seed.
struct Dice(u64);

impl Dice {
    fn roll(&mut self, count: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % count
    }
}

/// The digest of what was played, and that of a run of the scenario that it is written as.
fn digests(session: &Session) -> (String, String) {
    let text = session.played().to_file().to_toml();
    let again = from_text("played.toml", &text, &[]).expect("what was played is a scenario");
    (session.report().digest, run("again", &again, Vec::new()).expect("a run").digest)
}

/// Plays at random, with rewinds and hand-overs, for some ticks.
fn play(scenario: &Scenario, seat: &str, ticks: u64, dice: &mut Dice) -> Session {
    let mut session = Session::new("played", scenario, &[seat]).expect("a session");
    for _ in 0..ticks {
        match dice.roll(40) {
            0 => session.rewind(0.1 * dice.roll(30) as f64).expect("a moment before"),
            1 => session.hand_over(seat, Some("conservative")).expect("a planner"),
            2 | 3 => session.hand_over(seat, None).expect("the person again"),
            4..12 => {
                let axis = |dice: &mut Dice| dice.roll(201) as f64 / 100.0 - 1.0;
                let (acceleration, steering) = (axis(dice), 0.3 * axis(dice));
                let wish = Wish { seq: 1, acceleration, steering, assist: dice.roll(2) == 0 };
                session.wish(seat, wish).expect("a seat");
            }
            _ => {}
        }
        session.tick().expect("a tick");
    }
    session
}

#[test]
fn what_was_played_is_repeated_bit_for_bit() {
    let mut dice = Dice(7);
    for name in ["lane-change/front-nice", "intersection/nice", "ramp-merge/nice", "mixed/garage"] {
        let scenario = load(name, &[]).expect("authored");
        let seats = seats_of(&scenario);
        for play_number in 0..4 {
            let seat = &seats[dice.roll(seats.len() as u64) as usize];
            let session = play(&scenario, seat, 50, &mut dice);
            let (played, repeated) = digests(&session);
            assert_eq!(played, repeated, "{name} as {seat}, play {play_number}");
        }
    }
}

/// The same for every family, many times over: `cargo test --release -p interplay-play -- --ignored`.
#[test]
#[ignore = "takes minutes"]
fn two_hundred_plays_of_all_families_are_repeated() {
    let mut dice = Dice(3);
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
            let scenario = load(family[dice.roll(family.len() as u64) as usize], &[]).expect("authored");
            let seats = seats_of(&scenario);
            if seats.is_empty() {
                continue;
            }
            let seat = &seats[dice.roll(seats.len() as u64) as usize];
            let ticks = 20 + dice.roll(60);
            let session = play(&scenario, seat, ticks, &mut dice);
            let (played, repeated) = digests(&session);
            assert_eq!(played, repeated, "{} as {seat}, play {plays}", family[0]);
            plays += 1;
        }
    }
}

/// Planners are told nothing of what a person is about to do: as long as two people do the same, everybody plans the same.
#[test]
fn plans_are_equal_as_long_as_inputs_are() {
    const SAME: usize = 20;
    let scenario = load("lane-change/front-nice", &[]).expect("authored");
    let plays = [-1.0, 1.0].map(|later| {
        let mut session = Session::new("played", &scenario, &["front"]).expect("a session");
        let frames = (0..SAME + 10).filter_map(|tick| {
            let acceleration = if tick < SAME { 0.1 } else { later };
            session.wish("front", Wish { acceleration, assist: true, ..Wish::default() }).expect("a seat");
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
        // The seat's own plan in the tick of the first difference is what it did then.
        one.iter().zip(&other).enumerate().all(|(index, (one, other))| index == 1 || one == other)
    };
    assert!((0..=SAME).all(is_equal));
    assert!(!(SAME..SAME + 10).all(is_equal), "and afterwards they are not");
}

#[test]
fn a_seat_is_a_vehicle_that_somebody_drives() {
    let scenario = load("lane-change/front-nice", &[]).expect("authored");
    let error = Session::new("played", &scenario, &["nobody"]).err().map(|error| error.to_string());
    assert_eq!(error.as_deref(), Some("there is no seat `nobody`; choose from ego, front, rear"));
    let mut session = Session::new("played", &scenario, &["ego"]).expect("a session");
    assert!(session.hand_over("ego", Some("inputs")).is_err());
    assert!(session.wish("front", Wish::default()).is_err(), "nobody sits there");
}
