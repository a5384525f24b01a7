//! The problems of those planners whose diagnostics say all that the problem depends on, rebuilt from the diagnostics.

use interplay_planners::bayesian::diagnostics::{BELIEF_VARIANCE, LOYALTY};
use interplay_planners::diagnostic::COST;
use interplay_planners::game::diagnostics::{EXPRESSED_FROM, EXPRESSED_TO};
use interplay_planners::trajectory::terms::MeanSpeed;
use interplay_planners::trajectory::{Iterate, Penalty, Problem};
use interplay_planners::{Agent, Input, Plan, PlanEventKind, Trajectory, bayesian, cooperative, game};

use crate::closed_loop::Decision;
use crate::negotiation_replay::Posed;
use crate::{Result, cost_of_plan, stated};

/// What the problem of a step depends on and only earlier steps say.
#[derive(Default)]
pub struct StatedProblems {
    /// Whom the ego interacts with.
    partner: Option<String>,
    /// Everybody's part of the last joint plan, by name.
    joint: Vec<(String, Trajectory)>,
}

impl StatedProblems {
    /// The problem of the Bayesian planner while it persuades somebody.
    ///
    /// # Errors
    /// The rebuilt problem does not cost what the plan states.
    pub fn bayesian(&mut self, decision: &Decision, settings: &bayesian::Settings) -> Result<Option<Posed>> {
        let (scene, plan) = (decision.scene, decision.plan);
        for event in &plan.events {
            if let PlanEventKind::Partner(partner) = &event.kind {
                self.partner.clone_from(partner);
            }
        }
        let partner = scene.others.iter().find(|other| Some(&other.name) == self.partner.as_ref());
        if retreats(plan) || partner.is_none() {
            return Ok(None);
        }
        let (variance, w_1) = (stated(plan, &BELIEF_VARIANCE)?, stated(plan, &LOYALTY)?);
        let belief = bayesian::PersuasionBelief { variance, w_1, ..bayesian::PersuasionBelief::initial(settings) };
        let problem = bayesian::problem(scene, partner, &belief, settings);
        agrees(decision, cost_of_plan(&problem, plan))?;
        Ok(Some((problem, vec![keep(decision.last)])))
    }

    /// The problem of the game's planner while it expresses an intention.
    ///
    /// # Errors
    /// The rebuilt problem does not cost what the plan states.
    pub fn game(&mut self, decision: &Decision, settings: &game::Settings) -> Result<Option<Posed>> {
        let (scene, plan) = (decision.scene, decision.plan);
        let (Ok(lower), Ok(upper)) = (stated(plan, &EXPRESSED_FROM), stated(plan, &EXPRESSED_TO)) else {
            return Ok(None);
        };
        let limits = &scene.ego.limits;
        let expressed = MeanSpeed {
            lower_mps: Some(lower).filter(|lower| *lower > limits.speed_min_mps),
            upper_mps: Some(upper).filter(|upper| *upper < limits.speed_max_mps),
            penalty: Penalty { linear: settings.slack_weight * scene.horizon as f64, quadratic: 0.0 },
        };
        let problem = game::problem(scene, Some(expressed));
        agrees(decision, cost_of_plan(&problem, plan))?;
        Ok(Some((problem, vec![keep(decision.last)])))
    }

    /// The joint problem of two cooperating vehicles, once: as the ego sees it.
    ///
    /// # Errors
    /// The rebuilt problem does not cost what the plan states.
    pub fn cooperative(&mut self, decision: &Decision, settings: &cooperative::Settings) -> Result<Option<Posed>> {
        let (scene, plan) = (decision.scene, decision.plan);
        if scene.ego.name != "ego" || retreats(plan) {
            return Ok(None);
        }
        let cooperators = cooperative::cooperators(scene, settings.shared_goal(&scene.goal));
        let problem = cooperative::problem(scene, &cooperators);
        let other = plan.proposal.as_ref().ok_or("nobody cooperates")?;
        let parts = [(&scene.ego.name, &plan.trajectory), (&other.to, &other.trajectory)];
        let guess = cooperators.iter().map(|of| keep(part(&self.joint, &of.agent))).collect();
        self.joint = parts.map(|(name, trajectory)| (name.clone(), trajectory.clone())).into();
        agrees(decision, joint_cost(&problem, &cooperators, &self.joint).ok_or("a part is missing")?)?;
        Ok(Some((problem, guess)))
    }
}

fn retreats(plan: &Plan) -> bool {
    plan.events.iter().any(|event| event.kind == PlanEventKind::Retreat)
}

fn keep(last: Option<&Trajectory>) -> Vec<Input> {
    last.map_or_else(Vec::new, Trajectory::later_inputs)
}

fn part<'a>(joint: &'a [(String, Trajectory)], of: &Agent) -> Option<&'a Trajectory> {
    joint.iter().find(|(name, _)| *name == of.name).map(|(_, part)| part)
}

fn joint_cost(
    problem: &Problem,
    cooperators: &[cooperative::Cooperator],
    joint: &[(String, Trajectory)],
) -> Option<f64> {
    let parts: Option<Vec<&Trajectory>> = cooperators.iter().map(|of| part(joint, &of.agent)).collect();
    let parts = parts?;
    let inputs = parts.iter().map(|part| part.inputs.clone()).collect();
    let states = parts.iter().map(|part| part.states.clone()).collect();
    Some(problem.cost(&Iterate { inputs, states }).total)
}

fn agrees(decision: &Decision, cost: f64) -> Result<()> {
    let stated = stated(decision.plan, &COST)?;
    if cost != stated {
        let (tick, kind) = (decision.scene.tick, decision.driver.kind());
        return Err(format!("tick {tick}: the rebuilt {kind} problem costs {cost}, not {stated}").into());
    }
    Ok(())
}
