//! Acceptance where only motion is seen: how far the other is from where it would be if it had not been asked.
//!
//! At the first request the other is kept as it is seen, the **baseline** `B`, with what was proposed to it, `P`. At every step the
//! baseline is driven on as seen motion leads one to expect, behind the *present* leader of the other, so that braking for it does not count as consent.
//! With the place `s` of the other along its way and `I` the intrusion into the room of the ego's proposed motion,
//!
//! ```text
//! p_a = max((I(baseline) − I(seen))/(I(baseline) + 1), p_m),    p_m = clip((s_B − s)(s_B − s_P)/((s_B − s_P)² + σ²), 0, 1)
//! ```
//!
//! The first is what its motion promises, as if it were its new plan in eq. 6.19, where that differs from the baseline by more than the
//! spread of seen motion; the second what it has already done of what was asked.

use std::sync::Arc;

use super::acceptance::{MIN_INTRUSION, intrusion};
use crate::drivers::SeenMotion;
use crate::prediction::spread_m;
use crate::vehicle::OrientedEllipse;
use crate::{Agent, Scene, Trajectory};

/// `σ`: distances along the road below this say little, of real vehicles \[m\].
const SPREAD_M: f64 = 0.3;
/// Intrusions below this say little: an ellipse at one step.
const SPREAD_OF_INTRUSION: f64 = 1.0;

/// A vehicle as it would drive if it had not been asked, and the motion that was proposed to it first.
#[derive(Clone, Debug)]
pub(super) struct Baseline {
    unasked: Agent,
    /// What was expected of it when it was asked first, and what was proposed then, from the present step on.
    first: [Trajectory; 2],
}

impl Baseline {
    /// The baseline of a vehicle that is asked now.
    pub fn new(partner: &Agent, proposal: &Trajectory) -> Baseline {
        Baseline { unasked: partner.clone(), first: [(*partner.prediction).clone(), proposal.clone()] }
    }

    /// Drives on by one step, with what the rules and the leader ask of the vehicle now.
    pub fn advance(&mut self, scene: &Scene, partner: &Agent) {
        self.first = self.first.each_ref().map(Trajectory::shifted);
        let expected = &self.unasked.prediction;
        let (Some(state), Some(input)) = (expected.states.get(1), expected.inputs.first()) else { return };
        let mut unasked =
            Agent { state: *state, previous_input: *input, rules: partner.rules.clone(), ..self.unasked.clone() };
        let others = scene.others.iter().filter(|other| other.name != partner.name);
        let leader = unasked.leader_among(others);
        let motion = SeenMotion { vehicle: &unasked, leader }.expected(scene.horizon, scene.step_s);
        unasked.prediction = Arc::new(motion);
        self.unasked = unasked;
    }

    /// How far the vehicle accepts; none where the baseline leaves the room free, so that nothing is asked. `proposed` is the ego's motion in
    /// the last proposal, `ellipse` its ellipse around a place of the other.
    pub fn acceptance(
        &self,
        partner: &Agent,
        proposed: &Trajectory,
        step_s: f64,
        ellipse: impl Fn([f64; 2]) -> OrientedEllipse,
    ) -> Option<f64> {
        let unasked = intrusion(&self.unasked.prediction, proposed, &ellipse);
        if unasked < MIN_INTRUSION {
            return None;
        }
        let seen = intrusion(&self.within_spread(partner, step_s), proposed, &ellipse);
        let promised = ((unasked - seen) / (unasked + SPREAD_OF_INTRUSION)).clamp(0.0, 1.0);
        Some(promised.max(self.share_done(partner)))
    }

    /// What is expected of the vehicle, as near to the baseline as the spread of seen motion allows: what differs by less says nothing.
    fn within_spread(&self, partner: &Agent, step_s: f64) -> Trajectory {
        let mut motion = (*partner.prediction).clone();
        for (stage, (state, unasked)) in motion.states.iter_mut().zip(&self.unasked.prediction.states).enumerate() {
            let [dx_m, dy_m] = [unasked.x_m - state.x_m, unasked.y_m - state.y_m];
            let apart_m = libm::hypot(dx_m, dy_m);
            let spread_m = spread_m(&partner.body, step_s * stage as f64);
            let share = if apart_m > spread_m { spread_m / apart_m } else { 1.0 };
            (state.x_m, state.y_m) = (state.x_m + share * dx_m, state.y_m + share * dy_m);
        }
        motion
    }

    /// `p_m`: the share of what was proposed that the vehicle has done.
    fn share_done(&self, partner: &Agent) -> f64 {
        let [Some(first), Some(proposed)] = self.first.each_ref().map(|motion| motion.states.first()) else {
            return 0.0;
        };
        let [unasked_m, here_m, first_m, proposed_m] =
            [self.unasked.state, partner.state, *first, *proposed].map(|state| partner.route.along(state.position()));
        let (moved_m, asked_m) = (unasked_m - here_m, unasked_m - proposed_m);
        // It would do what was asked without being asked.
        if asked_m * (first_m - proposed_m) <= 0.0 {
            return 0.0;
        }
        let spread_m = SPREAD_M * partner.body.real_ratio();
        (moved_m * asked_m / (asked_m * asked_m + spread_m * spread_m)).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drivers::idm;
    use crate::drivers::negotiation::acceptance::Acceptance;
    use crate::drivers::negotiation::state::{NegotiationRound, NegotiationState};
    use crate::fixture;
    use crate::prediction::constant_velocity;
    use crate::scene::Knowledge;
    use crate::vehicle::ComfortLimits;
    use crate::{Bicycle, Input, SafetyEllipse, State};

    const STEP_S: f64 = 0.2;
    const HORIZON: usize = 40;
    /// The asked driver answers this much after it is asked \[s\].
    const REACTION_S: f64 = 0.6;
    /// Its answer counts from then on, and is clear after two more seconds \[s\].
    const ANSWER_S: f64 = 1.2;

    /// What an asked driver does.
    #[derive(Clone, Copy, PartialEq)]
    enum Answer {
        Yields,
        DrivesOn,
        BrakesForItsLeader,
    }

    /// The start of a talk, drawn: the gap behind the ego, speeds, braking and the gap to the leader.
    struct Draw {
        gap_m: f64,
        speed_mps: f64,
        faster_mps: f64,
        braking_mps2: f64,
        time_gap_s: f64,
    }

    impl Draw {
        fn of(number: usize) -> Draw {
            // Fractions that fill the unit interval evenly.
            let share = |step: f64| (0.5 + step * number as f64).fract();
            Draw {
                gap_m: 2.0 + 13.0 * share(0.618_034),
                speed_mps: 15.0 + 13.0 * share(0.754_878),
                faster_mps: 3.0 * share(0.569_840),
                braking_mps2: 1.0 + 1.5 * share(0.819_173),
                time_gap_s: 1.0 + 0.8 * share(0.671_044),
            }
        }
    }

    fn car(name: &str, [x_m, y_m]: [f64; 2], speed_mps: f64) -> Agent {
        let mut agent = Agent { name: name.to_owned(), ..fixture::real_car(x_m, speed_mps) };
        (agent.state.y_m, agent.limits.comfort) = (y_m, Some(ComfortLimits::default()));
        agent
    }

    /// The vehicle later, with what is expected of it then.
    fn driven(agent: &Agent, acceleration_mps2: f64, leader: Option<&Agent>) -> Agent {
        let input = Input { acceleration_mps2, steering_rad: 0.0 };
        let mut later = agent.clone();
        later.state = Bicycle::new(&agent.body, STEP_S).step(&agent.state, &input);
        later.state.speed_mps = later.state.speed_mps.max(0.0);
        later.previous_input = input;
        later.prediction = Arc::new(SeenMotion { vehicle: &later, leader }.expected(HORIZON, STEP_S));
        later
    }

    /// The ego's way into the lane to its left within 4 s, and what it asks of the vehicle behind: to brake gently after its answer.
    fn round(ego: &Agent, partner: &Agent) -> NegotiationRound {
        let mut cooperative = constant_velocity(&ego.state, HORIZON, STEP_S);
        for (step, state) in cooperative.states.iter_mut().enumerate() {
            state.y_m += 3.5 * (step as f64 * STEP_S / 4.0).min(1.0);
        }
        let inputs: Vec<Input> = (0..HORIZON)
            .map(|step| if (6..21).contains(&step) { -1.5 } else { 0.0 })
            .map(|acceleration_mps2| Input { acceleration_mps2, steering_rad: 0.0 })
            .collect();
        let mut states: Vec<State> = Vec::new();
        Bicycle::new(&partner.body, STEP_S).roll_out(&partner.state, &inputs, &mut states);
        NegotiationRound {
            cooperative,
            conservative: None,
            proposal: Trajectory { states, inputs },
            prediction: (*partner.prediction).clone(),
        }
    }

    /// The readings from when the answer counts until 2 s later.
    fn readings(answer: Answer, draw: &Draw) -> Vec<f64> {
        let mut ego = car("ego", [0.0, 0.0], draw.speed_mps - draw.faster_mps);
        let body = ego.body;
        let mut partner = car("partner", [-draw.gap_m - body.front_m - body.rear_m, 3.5], draw.speed_mps);
        let model = idm::Settings { headway_s: draw.time_gap_s, ..idm::Settings::literature() };
        // A gap that it keeps.
        let ahead_m = model.gap_m + draw.time_gap_s * draw.speed_mps + body.front_m + body.rear_m;
        let mut leader = car("leader", [partner.state.x_m + ahead_m, 3.5], draw.speed_mps);
        leader = driven(&leader, 0.0, None);
        partner = driven(&partner, 0.0, Some(&leader));
        ego = driven(&ego, 0.0, None);
        let mut negotiation = NegotiationState::default();
        let (mut wanted, mut read) = (Vec::new(), Vec::new());
        for step in 0_usize.. {
            let time_s = STEP_S * step as f64;
            if time_s > ANSWER_S + 2.0 {
                return read;
            }
            let mut scene = fixture::scene(ego.clone(), vec![partner.clone(), leader.clone()]);
            (scene.step_s, scene.horizon) = (STEP_S, HORIZON);
            scene.knowledge = Knowledge::Motion { late_steps: 0 };
            scene.goal.safety = SafetyEllipse { along_m: 7.0, across_m: 2.4 };
            negotiation.advance(&scene, &partner);
            let accepted = negotiation.acceptance(Acceptance::Willingness, &scene, &partner);
            read.extend(accepted.filter(|_| time_s > ANSWER_S - 1e-9));
            let round = round(&ego, &partner);
            negotiation.ask(&scene, &partner, &round.proposal);
            negotiation.remember(round);
            let gap_m = partner.lead_of(&leader) - body.front_m - body.rear_m;
            wanted.push(model.acceleration_behind(
                partner.state.speed_mps,
                f64::INFINITY,
                Some((gap_m, leader.state.speed_mps)),
            ));
            let answered = time_s > REACTION_S;
            let acceleration_mps2 = match answer {
                Answer::Yields if answered => -draw.braking_mps2,
                Answer::Yields => 0.0,
                // It does not hold its speed exactly.
                Answer::DrivesOn => 0.2 * libm::sin(2.0 * time_s + draw.gap_m),
                // As late as it sees everything else.
                Answer::BrakesForItsLeader => wanted[step.saturating_sub(3)].min(0.0),
            };
            let leader_mps2 = if answer == Answer::BrakesForItsLeader && time_s > 0.3 { -2.0 } else { 0.0 };
            leader = driven(&leader, leader_mps2, None);
            partner = driven(&partner, acceleration_mps2, Some(&leader));
            ego = driven(&ego, 0.0, None);
        }
        read
    }

    /// The readings at the end of 100 talks in which something is asked of the partner.
    fn last_readings(answer: Answer) -> Vec<f64> {
        let read: Vec<f64> =
            (0..1000).filter_map(|number| readings(answer, &Draw::of(number)).pop()).take(100).collect();
        assert_eq!(read.len(), 100);
        read
    }

    #[test]
    fn one_who_yields_is_read_as_accepting() {
        let read = last_readings(Answer::Yields);
        assert!(read.iter().all(|accepted| *accepted > 0.8), "{read:?}");
    }

    #[test]
    fn one_who_drives_on_is_read_as_refusing() {
        let read = last_readings(Answer::DrivesOn);
        assert!(read.iter().all(|accepted| *accepted < 0.2), "{read:?}");
    }

    #[test]
    fn one_who_brakes_for_its_leader_is_not_read_as_accepting() {
        let read = last_readings(Answer::BrakesForItsLeader);
        assert!(read.iter().all(|accepted| *accepted < 0.3), "{read:?}");
    }
}
