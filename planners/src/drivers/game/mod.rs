//! The persuasion game (chapter 8): which vehicle passes and which yields is decided by a game, and the outcome is shown by speed.
//!
//! At every step the planner
//!
//! 1. chooses whom to play with, one vehicle after the other ([`conflict_geometry`] says how their ways conflict);
//! 2. reads both intentions from behaviour by Bayes' rule: the other's, `p̃_s|e`, and what the other must think of the
//!    ego's, `p̃_e|s` ([`intention`], eq. 8.1-8.4); where it infers plans, what it believes of the other's driver is where
//!    the first begins and what it fades to;
//! 3. plays the game whose stakes follow from ratios of these intentions ([`payoff`], Table 8.2), valued as people value
//!    risks ([`prospect`], eq. 8.5-8.7), and takes the ego's intention `p_e` from its solution ([`equilibrium`], eq. 8.8,
//!    8.9, or [`logit`]);
//! 4. drives such that the other reads this intention: bounds on the mean speed ([`expression`], eq. 8.11-8.15) in the
//!    conservative problem (eq. 8.10). They give way at a price, never safety.
//!
//! [`GameForm`] chooses between the game as printed and the corrected one, which differs in steps 2 and 3.

pub mod best_response;
pub mod conflict_geometry;
pub mod diagnostics;
pub mod equilibrium;
pub mod expression;
pub mod intention;
pub mod logit;
pub mod payoff;
pub mod prospect;
mod settings;

use std::sync::Arc;

pub use settings::{ExpressedBounds, ExpressedSpeed, GameForm, Settings, SolutionConcept};

use serde_json::{Map, Value as Json, json};

use crate::drivers::conservative;
use crate::drivers::drive::{Drive, DriverKind, settings_of};
use crate::drivers::partner_choice::{PartnerChoice, PartnerSequence};
use crate::drivers::receding_horizon::Solved;
use crate::plan::diagnostic::{COST, RUNNER_UP_COST, SAFETY_SLACK};
use crate::scene::driver_estimate::{DriverEstimate, DriverModel};
use crate::scene::inferred_futures::InferredFutures;
use crate::trajectory::activity::Activity;
use crate::trajectory::terms::{MeanSpeed, SpeedMeasure};
use crate::trajectory::{Optimiser, Optimum, Problem, Robust, Term, Violation};
use crate::{Agent, Axes, Diagnostic, Plan, PlanError, PlanTime, Scene, Trajectory};
use best_response::{MAX_INTENTION, MIN_INTENTION};
use conflict_geometry::{ConflictGeometry, ObservedBehaviour};
use diagnostics as reported;
use equilibrium::{GameSolution, leader_follower, nash, solution};
use intention::forget;
use logit::quantal_response;
use payoff::{Stakes, TabulatedTheory};

/// The planner of the persuasion game (chapter 8) with its beliefs and its last plan.
#[derive(Clone, Debug)]
pub struct Game {
    settings: Settings,
    theory: TabulatedTheory,
    optimiser: Optimiser<Robust>,
    partner: PartnerSequence,
    intentions: Intentions,
    /// Largest speeds that the ego and its partner have driven since they met \[m/s\].
    fastest_mps: [f64; 2],
    last: Option<Trajectory>,
}

/// What is believed and intended.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Intentions {
    /// The other's intention as the ego reads it, `p̃_s|e`.
    other: f64,
    /// The ego's intention as the other must read it, `p̃_e|s`.
    seen: f64,
    /// The ego's intention, `p_e`: the last game's solution.
    own: f64,
}

impl Intentions {
    /// What is believed and intended before anything has been observed of a driver who usually passes with this probability.
    fn at_first(settings: &Settings, usual: f64) -> Self {
        let own = match settings.form {
            GameForm::Corrected => settings.first_intention,
            GameForm::AsPrinted => 0.5,
        };
        Intentions { other: usual, seen: 0.5, own }
    }
}

/// One game.
#[derive(Clone, Copy, Debug)]
struct Round {
    /// Stakes of the ego and of the other.
    stakes: [Stakes; 2],
    solution: GameSolution,
}

impl Game {
    /// A planner that has not interacted with any vehicle yet.
    pub fn new(settings: Settings) -> Self {
        Game {
            settings,
            theory: TabulatedTheory::new(settings.prospect),
            optimiser: Optimiser::receding_horizon(Robust::default()).searching(settings.passing_orders),
            partner: PartnerSequence::default(),
            intentions: Intentions::at_first(&settings, 0.5),
            fastest_mps: [0.0; 2],
            last: None,
        }
    }
}

impl DriverKind for Settings {
    fn kind(&self) -> &'static str {
        "game"
    }

    fn driver(&self) -> Box<dyn Drive> {
        Box::new(Game::new(*self))
    }

    fn plan_time(&self) -> PlanTime {
        PlanTime { alone_s: 0.42e-3, share_of_each_other: 0.4 }.searching(self.passing_orders)
    }

    fn explanation(&self) -> &'static crate::plan::diagnostic::Explanation {
        &diagnostics::EXPLANATION
    }

    fn prediction(&self) -> Option<crate::prediction::Prediction> {
        Some(self.prediction)
    }

    fn people_defaults(&self) -> Map<String, Json> {
        Map::from_iter([("answer_s".to_owned(), json!(0.9))])
    }
}

impl Drive for Game {
    /// Makes a plan for the scene: updates the beliefs, plays the game with the nearest partner, and expresses its
    /// solution by speed.
    ///
    /// # Errors
    /// [`PlanError`] if not even the conservative problem can be solved.
    fn plan(&mut self, scene: &Scene, inferred_futures: &InferredFutures) -> Result<Plan, PlanError> {
        let scene = &self.settings.prediction.applied_to(scene);
        let choice = self.partner.choose(scene, self.settings.clear_lead_m);
        let estimate = choice.partner.and_then(|partner| inferred_futures.estimate(&partner.name));
        let usual = estimate.map_or(0.5, usual_intention);
        if choice.is_new {
            self.intentions = Intentions::at_first(&self.settings, usual);
            let partner_mps = choice.partner.map_or(0.0, |partner| partner.state.speed_mps);
            self.fastest_mps = [scene.ego.state.speed_mps, partner_mps];
        }
        let geometry =
            choice.partner.and_then(|other| Some((other, ConflictGeometry::find(scene, other, &self.settings)?)));
        let (mut round, mut expressed) = (None, None);
        if let Some((other, geometry)) = geometry {
            let has_answered = choice.may_have_answered(self.settings.answer_s, scene.step_s);
            let ego_behaviour = self.watch(scene, other, has_answered, usual, &geometry);
            let played = self.play();
            self.intentions.own = played.solution.ego;
            expressed =
                self.is_expressing(scene, &choice, &geometry).then(|| self.express(scene, &geometry, &ego_behaviour));
            round = Some(played);
        }
        let problem = problem(scene, expressed.as_ref());
        let Solved { problem, optimum, event } =
            conservative::solve_or_fall_back(&mut self.optimiser, scene, problem, self.last.as_ref())?;
        let expressed = expressed.filter(|_| event.is_none());
        let diagnostics = self.diagnostics(scene, round.as_ref(), expressed.as_ref(), &problem, &optimum);
        let trajectory = optimum.trajectory(0);
        self.last = Some(trajectory.clone());
        let events = choice.event("plays the game with", "to play with").into_iter().chain(event).collect();
        let (problem, statistics) = (Some(Arc::new(problem)), optimum.statistics);
        Ok(Plan { trajectory, diagnostics, events, problem, statistics, ..Plan::default() })
    }

    fn fork(&self) -> Option<Box<dyn Drive>> {
        Some(Box::new(self.clone()))
    }

    fn with_settings(&self, settings: &dyn DriverKind) -> Option<Box<dyn Drive>> {
        let settings = *settings_of::<Settings>(settings)?;
        let optimiser = self.optimiser.clone().searching(settings.passing_orders);
        let theory = TabulatedTheory::new(settings.prospect);
        Some(Box::new(Game { settings, theory, optimiser, ..self.clone() }))
    }
}

impl Game {
    /// Renews both beliefs, that about the other only where it `has_answered`; returns what the next belief about the ego will be
    /// judged by.
    fn watch(
        &mut self,
        scene: &Scene,
        other: &Agent,
        has_answered: bool,
        usual: f64,
        geometry: &ConflictGeometry,
    ) -> ObservedBehaviour {
        let plan = self.last.as_ref().map(Trajectory::shifted);
        let ego_mps =
            plan.map_or(scene.ego.state.speed_mps, |plan| self.mean_speed_mps(&scene.ego, &plan, scene.step_s));
        let other_mps = self.mean_speed_mps(other, &other.prediction, scene.step_s);
        let driven_mps = [scene.ego.state.speed_mps, other.state.speed_mps];
        let observations = |fastest_mps: [f64; 2]| match self.settings.form {
            GameForm::Corrected => geometry.own_observations([ego_mps, other_mps], fastest_mps, &self.settings),
            GameForm::AsPrinted => geometry.observations([ego_mps, other_mps], &self.settings),
        };
        let [shown, seen] = observations(self.fastest_mps);
        let Intentions { other, seen: own, .. } = self.intentions;
        let prior = forget(other, self.settings.forgetting, usual);
        let beliefs = (
            if has_answered { seen.behaviour.posterior(prior, seen.observed) } else { other },
            shown.behaviour.posterior(self.prior(own), shown.observed),
        );
        // The next beliefs use the speeds of this step, so what is expressed now must use them too.
        let fastest_mps = std::array::from_fn(|who| self.fastest_mps[who].max(driven_mps[who]));
        let [expected, _] = observations(fastest_mps);
        (self.intentions.other, self.intentions.seen) = beliefs;
        self.fastest_mps = fastest_mps;
        expected
    }

    /// The mean speed of a vehicle's motion \[m/s\].
    fn mean_speed_mps(&self, agent: &Agent, motion: &Trajectory, step_s: f64) -> f64 {
        self.measure(agent, motion, step_s).evaluate(&motion.states)
    }

    /// What a mean speed is the mean of, with the directions of the road where a motion leads.
    fn measure(&self, agent: &Agent, motion: &Trajectory, step_s: f64) -> SpeedMeasure {
        match self.settings.expressed_speed {
            ExpressedSpeed::OfStates => SpeedMeasure::Speeds,
            ExpressedSpeed::AlongRoad => {
                let steps = motion.states.iter().take(motion.horizon());
                let headings = steps.map(|state| agent.route.heading_at(state.position()));
                SpeedMeasure::AlongRoad {
                    directions: headings.map(|heading| Axes::along(heading).vector([1.0, 0.0])).collect(),
                    step_s,
                }
            }
        }
    }

    /// The prior of the next belief: what is believed now, after forgetting.
    fn prior(&self, belief: f64) -> f64 {
        forget(belief, self.settings.forgetting, 0.5)
    }

    fn play(&self) -> Round {
        let (Intentions { other, seen, own }, settings) = (self.intentions, &self.settings);
        let ratios = [own / other, other / seen];
        let stakes = ratios.map(|ratio| match settings.form {
            GameForm::Corrected => Stakes::bounded(ratio, settings.accident),
            GameForm::AsPrinted => Stakes::of_ratio(ratio, settings.accident),
        });
        let [ego, other] = stakes.map(|stakes| self.theory.player(stakes));
        let played = match (settings.form, settings.solution) {
            (GameForm::Corrected, _) => {
                let [response, theirs] = quantal_response(&ego, &other, settings.temperature);
                let damped = own + settings.damping * (response - own);
                solution(&ego, &other, damped.clamp(MIN_INTENTION, MAX_INTENTION), theirs)
            }
            (GameForm::AsPrinted, SolutionConcept::LeaderFollower) => leader_follower(&ego, &other),
            (GameForm::AsPrinted, SolutionConcept::Nash) => nash(&ego, &other),
        };
        Round { stakes, solution: played }
    }

    /// Whether there is still something to show to the partner.
    fn is_expressing(&self, scene: &Scene, choice: &PartnerChoice, geometry: &ConflictGeometry) -> bool {
        let spoken_s = scene.step_s * choice.steps as f64;
        let in_time = match self.settings.form {
            GameForm::Corrected => true,
            GameForm::AsPrinted => choice.is_first || spoken_s <= self.settings.later_expression_s,
        };
        geometry.is_open() && in_time
    }

    fn express(&self, scene: &Scene, geometry: &ConflictGeometry, ego_behaviour: &ObservedBehaviour) -> MeanSpeed {
        let Intentions { own, seen, .. } = self.intentions;
        let motion = self.last.as_ref().map_or_else(|| (*scene.ego.prediction).clone(), Trajectory::shifted);
        let measure = self.measure(&scene.ego, &motion, scene.step_s);
        expression::mean_speed(own, self.prior(seen), geometry, ego_behaviour, scene, &self.settings, measure)
    }

    fn diagnostics(
        &self,
        scene: &Scene,
        round: Option<&Round>,
        expressed: Option<&MeanSpeed>,
        problem: &Problem,
        optimum: &Optimum,
    ) -> Vec<Diagnostic> {
        let mut diagnostics = Vec::new();
        if let Some(Round { stakes: [ego, other], solution }) = round {
            let Intentions { other: posterior, seen, .. } = self.intentions;
            diagnostics.extend([
                reported::OTHER_POSTERIOR.is(posterior),
                reported::EGO_POSTERIOR.is(seen),
                reported::EGO_INTENTION.is(solution.ego),
                reported::OTHER_INTENTION.is(solution.other),
                reported::EGO_TEMPTATION.is(solution.temptation[0]),
                reported::OTHER_TEMPTATION.is(solution.temptation[1]),
            ]);
            for (quantities, stakes) in [(reported::EGO_PAYOFFS, ego), (reported::OTHER_PAYOFFS, other)] {
                let [[stalemate, wait], [turn, _]] = stakes.payoffs();
                let payoffs = quantities.iter().zip([stalemate, wait, turn]);
                diagnostics.extend(payoffs.map(|(quantity, payoff)| quantity.is(payoff)));
            }
            diagnostics.push(reported::ACCIDENT_PAYOFF.is(ego.payoffs()[1][1]));
        }
        if let Some(bound) = expressed {
            let limits = &scene.ego.limits;
            diagnostics.extend([
                reported::EXPRESSED_FROM.is(bound.lower_mps.unwrap_or(limits.speed_min_mps)),
                reported::EXPRESSED_TO.is(bound.upper_mps.unwrap_or(limits.speed_max_mps)),
                reported::EXPRESSION_SLACK.is(optimum.cost.violation(Violation::MeanSpeed)),
            ]);
        }
        diagnostics.extend([
            reported::MEAN_SPEED.is(self.mean_speed_mps(&scene.ego, &optimum.trajectory(0), scene.step_s)),
            COST.is(optimum.cost.total),
            SAFETY_SLACK.is(optimum.cost.violation(Violation::Safety)),
        ]);
        diagnostics.extend(optimum.runner_up_cost.map(|cost| RUNNER_UP_COST.is(cost)));
        diagnostics.extend(Activity::count(problem, &optimum.iterate, 0).diagnostics());
        diagnostics
    }
}

/// The intention that a driver is taken to have before it shows one: the probability that it does not yield.
fn usual_intention(estimate: &DriverEstimate) -> f64 {
    let passes = |model: DriverModel| match model {
        DriverModel::Normal | DriverModel::Nice => 0.0,
        DriverModel::Tough | DriverModel::Idm => 1.0,
        DriverModel::Unknown => 0.5,
    };
    estimate.mean(passes).clamp(MIN_INTENTION, MAX_INTENTION)
}

/// The conservative problem (eq. 8.10) with the bounds that express an intention.
pub fn problem(scene: &Scene, expressed: Option<&MeanSpeed>) -> Problem {
    let others: Vec<&Agent> = scene.others.iter().collect();
    let mut problem = conservative::problem(scene, &others);
    problem.terms.extend(expressed.iter().flat_map(|interval| interval.bounds(0)).map(Term::MeanSpeed));
    problem
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_driver_believed_tough_is_expected_to_pass() {
        let usual = |probabilities| usual_intention(&DriverEstimate::new("other", DriverModel::Nice, probabilities));
        assert_eq!(usual([1.0, 0.0, 0.0, 0.0, 0.0]), MAX_INTENTION);
        assert_eq!(usual([0.0, 0.0, 1.0, 0.0, 0.0]), MIN_INTENTION);
        assert!((usual([0.2, 0.3, 0.3, 0.1, 0.1]) - 0.35).abs() < 1e-12);
    }
}
