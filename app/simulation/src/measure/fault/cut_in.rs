//! Vehicles that come into the way of another one with a shorter gap than they owe.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_1_SQRT_2;

use interplay_planners::State;
use interplay_planners::scene::duties::{needed_braking_mps2, owed_gap_m};

use super::road_user::RoadUser;
use crate::state::frame::{Event, Frame, Level};
use crate::state::standing::STANDING_MPS;

/// A vehicle may come into the way of one to whose direction it moves sideways faster than this, for a real car \[m/s\].
const SIDEWAYS_MPS: f64 = 0.05;

/// A vehicle has come into the way of one behind it with a shorter gap than it owes.
#[derive(Clone, Copy, Debug)]
pub(super) struct CutIn {
    time_s: f64,
    gap_m: f64,
    owed_m: f64,
    behind_mps: f64,
    needed_mps2: f64,
}

impl CutIn {
    pub fn sentence(&self, [came, behind]: [&str; 2]) -> String {
        if self.gap_m <= 0.0 {
            return format!("{came} came into the way of {behind} beside it");
        }
        let gap_s = self.gap_m / self.behind_mps;
        let needed = match self.needed_mps2 {
            mps2 if mps2.is_infinite() => "could not have braked in time".to_owned(),
            mps2 if mps2 > 0.0 => format!("needed {mps2:.1} m/s²"),
            _ => format!("was owed {:.1} s", self.owed_m / self.behind_mps),
        };
        format!("{came} came into the way {gap_s:.1} s ahead of {behind}, which {needed}")
    }

    /// What one vehicle did to one behind it between two moments, if the gap was too short and the first closed in sideways.
    fn between([own, other]: [&RoadUser; 2], [before, after]: [[&State; 2]; 2], time_s: f64) -> Option<CutIn> {
        let [now, their_now] = after;
        let (behind_mps, ahead_mps) = (their_now.speed_mps, now.speed_mps);
        let turned_rad = now.heading_rad - their_now.heading_rad;
        let is_sideways = ahead_mps.max(behind_mps) * libm::sin(turned_rad).abs() > SIDEWAYS_MPS * own.time_ratio();
        let stands = behind_mps < STANDING_MPS * other.time_ratio();
        if !is_sideways || stands {
            return None;
        }
        let across_m = |states: [&State; 2]| states.map(|state| other.route.across(state.position()));
        let ([own_then_m, their_then_m], [own_m, their_m]) = (across_m(before), across_m(after));
        let half_m = 0.5 * (own.body.width_m + other.body.width_m);
        let comes = (own_then_m - their_then_m).abs() >= half_m && (own_m - their_m).abs() < half_m;
        let [closed_m, their_closed_m] = [
            (own_then_m - their_then_m).abs() - (own_m - their_then_m).abs(),
            (own_then_m - their_then_m).abs() - (own_then_m - their_m).abs(),
        ];
        if !comes || closed_m < their_closed_m || libm::cos(turned_rad) < FRAC_1_SQRT_2 {
            return None;
        }
        let [along_m, their_along_m] = after.map(|state| other.route.along(state.position()));
        let gap_m = along_m - own.body.rear_m - their_along_m - other.body.front_m;
        let owed_m = owed_gap_m(&other.body, behind_mps, ahead_mps);
        (along_m > their_along_m && gap_m < owed_m).then(|| {
            let needed_mps2 = needed_braking_mps2(&other.body, gap_m, behind_mps, ahead_mps);
            CutIn { time_s, gap_m, owed_m, behind_mps, needed_mps2 }
        })
    }
}

/// The cut-ins of the last seconds, by the vehicle that came and the one behind it.
#[derive(Clone, Debug, Default)]
pub(super) struct CutIns(BTreeMap<[usize; 2], CutIn>);

impl CutIns {
    /// The last cut-in of a vehicle ahead of another one.
    pub fn of(&self, pair: [usize; 2]) -> Option<&CutIn> {
        self.0.get(&pair)
    }

    /// Notes which vehicles have come into the way of one behind them in a tick with less than the gap that they owe.
    pub fn note(&mut self, users: &[RoadUser], frame: &mut Frame, after: &[State]) {
        self.0.retain(|pair, cut_in| frame.time_s - cut_in.time_s <= users[pair[0]].remembered_s());
        let is_judged = |index: &usize| users[*index].knows_comfort && !frame.vehicles[*index].is_absent;
        let judged: Vec<usize> = (0..users.len().min(after.len())).filter(is_judged).collect();
        let mut found = Vec::new();
        for behind in &judged {
            let (theirs, user) = (&after[*behind], &users[*behind]);
            let reach_m = owed_gap_m(&user.body, theirs.speed_mps, 0.0) + 2.0 * user.length_m();
            let is_near = |came: &&usize| {
                let [dx_m, dy_m] = [after[**came].x_m - theirs.x_m, after[**came].y_m - theirs.y_m];
                *came != behind && dx_m * dx_m + dy_m * dy_m < reach_m * reach_m
            };
            for came in judged.iter().filter(is_near) {
                let before = [came, behind].map(|index| &frame.vehicles[*index].state);
                let then = [came, behind].map(|index| &after[*index]);
                if let Some(entry) = CutIn::between([&users[*came], user], [before, then], frame.time_s) {
                    found.push(([*came, *behind], entry));
                }
            }
        }
        for ([came, behind], entry) in found {
            let [name, other] = [came, behind].map(|index| users[index].name.clone());
            let text = entry.sentence([&name, &other]);
            frame.events.push(Event { vehicle: name.clone(), level: Level::Note, text });
            frame.cut_ins.push(name);
            self.0.insert([came, behind], entry);
        }
    }
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::from_text;

    use super::super::Faults;
    use super::*;
    use crate::state::frame::VehicleFrame;

    /// Two real cars on two lanes; one comes from the right lane into the left one ahead of the other, which drives there.
    fn cut_in(gap_m: f64, behind_mps: f64) -> Faults {
        let text = "title = 'two lanes'\nshows = 'two cars'\ndefaults = { class = 'car' }\nroad = { kind = 'lanes', lane_count = 2 }\n\
                    vehicle = [{ name = 'ego', start = { lane = 0, along_m = 0, speed_mps = 20 } }, \
                    { name = 'rear', start = { lane = 1, along_m = -30, speed_mps = 20 } }]";
        let scenario = from_text("cut-in.toml", text, &[]).expect("a scenario without fault");
        let mut faults = Faults::new(&scenario.vehicles, 0);
        let body = scenario.vehicles[0].body;
        let lanes_m = [0, 1].map(|index| scenario.vehicles[index].start.y_m);
        let half_m = 0.5 * (lanes_m[1] - lanes_m[0]);
        let ahead_m = gap_m + body.rear_m + body.front_m;
        let rear =
            |time_s: f64| State { x_m: behind_mps * time_s, y_m: lanes_m[1], heading_rad: 0.0, speed_mps: behind_mps };
        let ego = |time_s: f64| State {
            x_m: ahead_m + 20.0 * time_s,
            y_m: lanes_m[0] + half_m + time_s,
            heading_rad: 0.05,
            speed_mps: 20.0,
        };
        for tick in -20..20 {
            let [time_s, end_s] = [0, 1].map(|later| 0.1 * f64::from(tick + later));
            let frame =
                |name: &str, state: State| VehicleFrame { name: name.to_owned(), state, ..VehicleFrame::default() };
            let vehicles = vec![frame("ego", ego(time_s)), frame("rear", rear(time_s))];
            let mut frame = Frame { time_s, vehicles, ..Frame::default() };
            faults.observe(&mut frame, &[ego(end_s), rear(end_s)], 0.1);
        }
        faults
    }

    #[test]
    fn a_vehicle_that_comes_too_near_ahead_of_another_is_at_fault() {
        let sentence = |gap_m: f64, behind_mps: f64| {
            let cut_ins = cut_in(gap_m, behind_mps).cut_ins;
            cut_ins.of([0, 1]).map(|cut_in| cut_in.sentence(["ego", "rear"]))
        };
        assert_eq!(sentence(20.0, 20.0), None, "12 m and 2 m are owed at 20 m/s");
        let near = sentence(8.0, 20.0).expect("a gap that is too short");
        assert!(near.starts_with("ego came into the way 0.4 s ahead of rear, which was owed 0.7 s"), "{near}");
        let faster = sentence(20.0, 25.0).expect("a gap that is too short for one that comes from behind");
        assert!(faster.contains("which needed"), "{faster}");
    }
}
