//! Zones that plan together (chapter 5), and the same day in one problem.
//!
//! Both plan the inputs of least cost with a soft comfort band, and follow them with a feedback of each zone on its own error. The
//! distributed design plans by messages between neighbours: `messages` contains the messages, `zone` the problem of one zone, `agreement`
//! the rounds, and [`cooperative`](super::cooperative) the learning from neighbours and its convergence.
//!
//! The centralised problem, with temperatures as variables, is sparse and much faster than any exchange; the "exponential"
//! growth of the dissertation belongs to the dense form. The advantages of the exchange are privacy and robustness: a zone informs
//! its neighbours only, and the others continue when one fails.

mod agreement;
mod messages;
mod settings;
mod step_space;
mod zone;

pub use settings::{CentralisedSettings, DistributedSettings, Scheme};

use super::cooperative::{Conditions, LearningLaw, cooperative_error};
use super::disturbance_estimate::DisturbanceEstimator;
use super::interface::{Control, ControllerKind};
use super::optimum::{ConstraintTightening, check_size, operations_of_optimum, plan};
use super::planning::{DayPlan, PlanHistory, PlanningDesign};
use super::{ControlError, DayAhead, Design, Exchange, Observation};
use crate::comfort::Targets;
use crate::discretise::Model;
use crate::lifted::Lifted;
use crate::network::PowerLimits;
use agreement::Rules;
use messages::Messages;
use settings::penalty;
use step_space::JointDay;
use zone::ZoneModels;

/// The controller of the distributed design (chapter 5) with its state.
#[derive(Clone, Debug)]
pub struct Distributed {
    settings: DistributedSettings,
    estimator: DisturbanceEstimator,
    history: PlanHistory,
    messages: Messages,
    /// Feedback of each zone on its own error.
    gains_kw_per_k: Vec<f64>,
    zone_models: Option<(Targets, ZoneModels)>,
}

/// The controller that solves the problem of the distributed design centrally (eq. 5.12), with its state.
#[derive(Clone, Debug)]
pub struct Centralised {
    settings: CentralisedSettings,
    estimator: DisturbanceEstimator,
    history: PlanHistory,
}

impl Distributed {
    /// The design before its first day. `model` is the zones' model of the building, `steps` the number of steps of a day.
    /// The zones plan with forward Euler, because only there a zone's step depends on its neighbours alone.
    ///
    /// # Errors
    /// [`ControlError::Setting`] if a setting is out of range; [`ControlError::Model`] if forward Euler would be unstable.
    pub fn new(settings: DistributedSettings, model: &Model, steps: usize) -> Result<Self, ControlError> {
        settings.check(model.network().zone_count())?;
        let lifted = Lifted::new(&Model::euler(model.network(), model.step_s())?, steps);
        let messages = Messages::new(&lifted, settings.loss, settings.delay_rounds, settings.silent_zone);
        let gains_kw_per_k =
            gain_limits_kw_per_k(&lifted).into_iter().map(|most| settings.gain_kw_per_k.min(most)).collect();
        let estimator = DisturbanceEstimator::new(lifted, settings.prediction, settings.learning_rate);
        let history = PlanHistory::default();
        Ok(Self { settings, estimator, history, messages, gains_kw_per_k, zone_models: None })
    }

    /// The convergence conditions of the learning law that leads from yesterday to the plan, where all zones have the same gain.
    fn conditions(&self, lifted: &Lifted, targets: &Targets, plan: &DayPlan) -> Option<Conditions> {
        let (n, gain) = (lifted.zones(), self.settings.gain_kw_per_k);
        let uniform = self.gains_kw_per_k.iter().all(|own| *own == gain);
        let yesterday = self.history.yesterday().filter(|_| uniform)?;
        let errors_k = |temperatures_c: &[f64]| -> Vec<f64> {
            targets.reference_c.iter().zip(temperatures_c).map(|(wanted, actual)| wanted - actual).collect()
        };
        let planned_k = errors_k(&plan.temperatures_c);
        let change_kw: Vec<f64> = (0..lifted.size())
            .map(|k| {
                let fed_back_kw = if k < n { 0.0 } else { gain * planned_k[k - n] };
                plan.heat_kw[k] - fed_back_kw - yesterday.heat_kw[k]
            })
            .collect();
        let cooperative_k = cooperative_error(lifted, &errors_k(&yesterday.temperatures_c));
        Some(LearningLaw::recovered(n, &change_kw, &cooperative_k).conditions(lifted, gain))
    }
}

/// The largest gain of each zone whose own error does not change its sign within a step of forward Euler: c/h less the
/// conductance to outdoors and to all neighbours, at least 0 \[kW/K\].
///
/// A zone that settles within little more than a step has a model with an oscillation which the building does not have. With a
/// larger gain the oscillation grows, and what is learned from it makes each day dearer than the one before.
fn gain_limits_kw_per_k(lifted: &Lifted) -> Vec<f64> {
    let (network, step_s) = (lifted.model().network(), lifted.model().step_s());
    let mut leaving_kw_per_k = network.ambient_kw_per_k().to_vec();
    for link in network.links() {
        leaving_kw_per_k[link.from] += link.conductance_kw_per_k;
        leaving_kw_per_k[link.to] += link.conductance_kw_per_k;
    }
    let limit = |zone: usize| (network.capacities_kj_per_k()[zone] / step_s - leaving_kw_per_k[zone]).max(0.0);
    (0..lifted.zones()).map(limit).collect()
}

/// All heat into the nodes but that of the equipment \[kW\], nodes of a step together: what leads to `free_c`. The learned
/// bias is in it.
fn driving_kw(lifted: &Lifted, day_ahead: &DayAhead<'_>, free_c: &[f64]) -> Vec<f64> {
    let network = lifted.model().network();
    let (n, nodes, gained) = (lifted.zones(), network.node_count(), network.gain_count());
    let forecast = day_ahead.forecast;
    let forecast_c = lifted.free_response(day_ahead.initial_c, &forecast.ambient_c, &forecast.gains_kw);
    let more_c: Vec<f64> = free_c.iter().zip(&forecast_c).map(|(all, forecast)| all - forecast).collect();
    let more_kw = lifted.solve(&more_c);
    let mut driving_kw = Vec::with_capacity(nodes * lifted.steps());
    for (t, ambient_c) in forecast.ambient_c.iter().enumerate() {
        driving_kw.extend(network.ambient_kw_per_k().iter().enumerate().map(|(node, k)| {
            let gain_kw = if node < gained { forecast.gains_kw[t * gained + node] } else { 0.0 };
            k * ambient_c + if node < n { gain_kw + more_kw[t * n + node] } else { gain_kw }
        }));
    }
    driving_kw
}

/// The centralised optimum.
fn central(
    lifted: &Lifted,
    free_c: &[f64],
    targets: &Targets,
    discomfort_quadratic: f64,
) -> Result<super::DayOptimum, ControlError> {
    plan(lifted, free_c, targets, Some(penalty(discomfort_quadratic)), &ConstraintTightening::default())
}

/// Each zone follows its plan with feedback on its own error; on the first day it follows the targets.
fn follow(
    history: &PlanHistory,
    gain_kw_per_k: impl Fn(usize) -> f64,
    limits: &PowerLimits,
    observation: &Observation<'_>,
) -> Vec<f64> {
    let Observation { step, temperatures_c, .. } = *observation;
    let n = temperatures_c.len();
    let (planned_kw, deviation_k) = match history.plan() {
        Some(plan) => (plan.heat_at(step, n).to_vec(), plan.deviation_k(step, temperatures_c)),
        None => (vec![0.0; n], Some(observation.weighted_errors_k())),
    };
    (0..n)
        .map(|i| {
            let correction_kw = deviation_k.as_ref().map_or(0.0, |deviation_k| gain_kw_per_k(i) * deviation_k[i]);
            limits.limited(i, planned_kw[i] + correction_kw)
        })
        .collect()
}

impl ControllerKind for DistributedSettings {
    fn kind(&self) -> &'static str {
        "distributed"
    }

    fn look_for(&self) -> &'static str {
        "zones that send messages to their neighbours only agree on a common plan round by round, and cool before people come"
    }

    fn needs_equal_days(&self) -> Option<(&'static str, &'static str)> {
        self.prediction.needs_equal_days()
    }

    fn plans(&self) -> bool {
        true
    }

    fn controller(&self, model: &Model, steps: usize) -> Result<Box<dyn Control>, ControlError> {
        if self.compare {
            check_size(model)?;
        }
        Ok(Box::new(Distributed::new(*self, model, steps)?))
    }

    fn operations_per_day(&self, zones: f64, steps: f64) -> f64 {
        let compared = if self.compare { operations_of_optimum(zones, steps) } else { 0.0 };
        let exchange = 4.0 * self.rounds as f64 * zones * steps.powi(2);
        20.0 * zones * steps.powi(3) + exchange + compared
    }
}

impl PlanningDesign for Distributed {
    fn parts(&mut self) -> (&mut DisturbanceEstimator, &mut PlanHistory) {
        (&mut self.estimator, &mut self.history)
    }

    fn history(&self) -> &PlanHistory {
        &self.history
    }

    fn plan(&mut self, day_ahead: &DayAhead<'_>) -> Result<(Option<DayPlan>, Design), ControlError> {
        let free_c = self.estimator.expect(day_ahead)?;
        if self.estimator.is_empty() {
            return Ok((None, Design::default()));
        }
        let targets = day_ahead.targets;
        let lifted = self.estimator.lifted().clone();
        let penalty = penalty(self.settings.discomfort_quadratic);
        if self.zone_models.as_ref().is_none_or(|(known, _)| known != targets) {
            self.zone_models = Some((targets.clone(), ZoneModels::new(&lifted, targets, penalty, &self.messages)));
        }
        let Some((_, zone_models)) = &self.zone_models else { return Ok((None, Design::default())) };
        let driving_kw = driving_kw(&lifted, day_ahead, &free_c);
        let day = JointDay {
            lifted: &lifted,
            targets,
            penalty,
            zone_models,
            initial_c: day_ahead.initial_c,
            driving_kw: &driving_kw,
            free_c: &free_c,
            silent: self.settings.silent_zone,
        };
        let rules = Rules {
            scheme: if self.settings.delay_rounds == 0 { self.settings.scheme } else { Scheme::Jacobi },
            tolerance_kw: self.settings.tolerance_kw,
            rounds: self.settings.rounds,
            delay: self.settings.delay_rounds,
        };
        self.messages.start(day_ahead.initial_c);
        let first_kw = self.history.yesterday().map_or(vec![0.0; lifted.size()], |yesterday| yesterday.heat_kw.clone());
        let agreement = day.agree(&mut self.messages, rules, first_kw)?;
        let temperatures_c = free_c.iter().zip(lifted.product(&agreement.heat_kw)).map(|(free, rise)| free + rise);
        let plan = DayPlan { temperatures_c: temperatures_c.collect(), heat_kw: agreement.heat_kw };
        let centralised = match self.settings.compare {
            true => Some(central(&lifted, &free_c, targets, self.settings.discomfort_quadratic)?.objective),
            false => None,
        };
        let conditions = self.conditions(&lifted, targets, &plan);
        let design = Design {
            objective: agreement.costs.last().copied(),
            bias_kw: self.estimator.bias_kw().to_vec(),
            spectral_radius: conditions.map(|conditions| conditions.spectral_radius),
            largest_singular_value: conditions.map(|conditions| conditions.largest_singular_value),
            exchange: Some(Exchange {
                costs: agreement.costs,
                centralised,
                messages: self.messages.sent.clone(),
                undelivered: self.messages.undelivered,
                sums: agreement.sums,
            }),
            ..Design::default()
        };
        Ok((Some(plan), design))
    }

    fn follow(&mut self, observation: &Observation<'_>) -> Vec<f64> {
        let limits = self.estimator.lifted().model().network().limits();
        follow(&self.history, |zone| self.gains_kw_per_k[zone], limits, observation)
    }
}

impl Centralised {
    /// A controller before its first day. `lifted` is its model of a day.
    ///
    /// # Errors
    /// [`ControlError::Setting`] if a setting is out of range.
    pub fn new(settings: CentralisedSettings, lifted: Lifted) -> Result<Self, ControlError> {
        settings.check()?;
        let estimator = DisturbanceEstimator::new(lifted, settings.prediction, settings.learning_rate);
        Ok(Self { settings, estimator, history: PlanHistory::default() })
    }
}

impl ControllerKind for CentralisedSettings {
    fn kind(&self) -> &'static str {
        "centralised"
    }

    fn look_for(&self) -> &'static str {
        "one problem for the whole building, whose optimum the zones of the distributed design approach"
    }

    fn needs_equal_days(&self) -> Option<(&'static str, &'static str)> {
        self.prediction.needs_equal_days()
    }

    fn plans(&self) -> bool {
        true
    }

    fn controller(&self, model: &Model, steps: usize) -> Result<Box<dyn Control>, ControlError> {
        check_size(model)?;
        Ok(Box::new(Centralised::new(*self, Lifted::new(model, steps))?))
    }

    fn operations_per_day(&self, zones: f64, steps: f64) -> f64 {
        operations_of_optimum(zones, steps)
    }
}

impl PlanningDesign for Centralised {
    fn parts(&mut self) -> (&mut DisturbanceEstimator, &mut PlanHistory) {
        (&mut self.estimator, &mut self.history)
    }

    fn history(&self) -> &PlanHistory {
        &self.history
    }

    fn plan(&mut self, day_ahead: &DayAhead<'_>) -> Result<(Option<DayPlan>, Design), ControlError> {
        let free_c = self.estimator.expect(day_ahead)?;
        if self.estimator.is_empty() {
            return Ok((None, Design::default()));
        }
        let lifted = self.estimator.lifted();
        let optimum = central(lifted, &free_c, day_ahead.targets, self.settings.discomfort_quadratic)?;
        let bias_kw = self.estimator.bias_kw().to_vec();
        let design = Design { objective: Some(optimum.objective), bias_kw, ..Design::default() };
        Ok((Some(DayPlan::from(&optimum)), design))
    }

    fn follow(&mut self, observation: &Observation<'_>) -> Vec<f64> {
        let limits = self.estimator.lifted().model().network().limits();
        follow(&self.history, |_| self.settings.gain_kw_per_k, limits, observation)
    }
}
