//! Measures of a building, day by day.

use bevy_ecs::prelude::*;
use interplay_building::comfort::Targets;
use interplay_building::control::{Controller, DayRecord, optimum};
use interplay_building::day::{KeyFigures, MAX_REGRET_INPUTS, RunHistory, ZoneFigures};
use interplay_building::discretise::Model;
use interplay_building::lifted::Lifted;
use serde::Serialize;
use xxhash_rust::xxh3::Xxh3;

use super::milestones::Today;
use crate::climate::{Building, Node, Temperature};
use crate::plants::Benchmark;
use crate::state::components::CurrentFrame;
use crate::state::day::{DayAheadErrors, DayFigures, ExchangeFigures};
use crate::state::frame::{BuildingFrame, Frame};
use crate::state::whole_run::WholeRun;
use crate::state::worst_zones::WorstZones;

/// Why a day had no plan of its own.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Fallback {
    /// The day, from 1.
    pub day: usize,
    /// What its controller did instead, and why.
    pub reason: String,
}

/// Digests of the results of each part of the phase Climate.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct BuildingDigests {
    /// Digest of the weather, its forecasts, and the heat of people and sun.
    pub disturbance: String,
    /// Digest of the heat that the controller requested.
    pub control: String,
    /// Digest of the heat that was given and of all temperatures of zones.
    pub balance: String,
}

/// All measures of a building.
#[derive(Resource, Clone)]
pub struct BuildingMeasures {
    /// Every day.
    pub days: Vec<DayFigures>,
    /// The zones on every day, in the order of the network.
    pub zone_days: Vec<Vec<ZoneFigures>>,
    /// The currency of costs; none without a tariff.
    pub currency: Option<String>,
    /// The days without a plan of their own.
    pub fallbacks: Vec<Fallback>,
    /// Days whose feedback has a weaker certificate than requested.
    pub weaker_feedbacks: Vec<Fallback>,
    /// Number of zones.
    pub zones: usize,
    /// Their names.
    pub zone_names: Vec<String>,
    /// The indicators of a benchmark as the plant, after its last step.
    pub benchmark: Option<Benchmark>,
    /// Settings that are allowed but may be unintended, in words.
    pub remarks: Vec<String>,
    /// The model of a day, if it is small enough for expensive computations.
    lifted: Option<Lifted>,
    /// Inputs of the optimum of the whole run, with the model; none if another program simulates the building.
    whole_run: Option<(Model, RunHistory)>,
    spectral_radius: Option<f64>,
    today: Today,
    disturbance: Xxh3,
    control: Xxh3,
    balance: Xxh3,
}

impl BuildingMeasures {
    /// Measures before the first day.
    pub fn new(building: &Building, controller: &Controller) -> Self {
        // The analysis of convergence also takes time proportional to the cube of the number of inputs.
        let small = building.targets.reference_c.len() <= MAX_REGRET_INPUTS;
        let lifted = small.then(|| Lifted::new(&building.model, building.steps_per_day()));
        let spectral_radius = lifted.as_ref().and_then(|lifted| controller.spectral_radius(lifted));
        BuildingMeasures {
            days: Vec::new(),
            zone_days: Vec::new(),
            currency: building.agenda.currency().map(str::to_owned),
            fallbacks: Vec::new(),
            weaker_feedbacks: Vec::new(),
            zones: building.targets.zones,
            zone_names: building.model.network().names()[..building.targets.zones].to_vec(),
            remarks: building.model.network().remarks().iter().map(ToString::to_string).collect(),
            benchmark: None,
            lifted,
            whole_run: (!building.plant.is_foreign()).then(|| (building.model.clone(), RunHistory::default())),
            spectral_radius,
            today: Today::default(),
            disturbance: Xxh3::new(),
            control: Xxh3::new(),
            balance: Xxh3::new(),
        }
    }

    /// The digests so far.
    pub fn digests(&self) -> BuildingDigests {
        let hex = |hasher: &Xxh3| format!("{:032x}", hasher.digest128());
        BuildingDigests {
            disturbance: hex(&self.disturbance),
            control: hex(&self.control),
            balance: hex(&self.balance),
        }
    }

    fn digest(&mut self, frame: &BuildingFrame) {
        let number = |hasher: &mut Xxh3, value: f64| hasher.update(&value.to_bits().to_le_bytes());
        number(&mut self.disturbance, frame.ambient_c);
        number(&mut self.disturbance, frame.forecast_c);
        for zone in &frame.zones {
            number(&mut self.disturbance, zone.gains_kw);
            number(&mut self.control, zone.requested_kw);
            number(&mut self.balance, zone.heat_kw);
            number(&mut self.balance, zone.temperature_c);
            number(&mut self.balance, zone.next_c);
        }
    }

    /// The optimum of all days so far; `None` if it is unknown or too expensive.
    pub fn whole_run(&self) -> Option<WholeRun> {
        let (model, history) = self.whole_run.as_ref().filter(|(_, history)| history.is_small())?;
        WholeRun::compute(model, history, &self.days)
    }

    /// The figures of the day that has ended.
    fn day(&self, building: &Building) -> DayFigures {
        let Building { model, targets, today, design_s, .. } = building;
        // The cost of heat depends on the actual weather, not on its forecast.
        let targets = &*targets.under(&today.actual.ambient_c);
        let limits = model.network().limits();
        let figures = KeyFigures::compute(&today.record, targets, limits, model.step_s());
        // If no optimum is found, the run continues and the regret is unknown. The optimum of the network does not
        // apply to another program.
        let lifted = self.lifted.as_ref().filter(|_| !building.plant.is_foreign());
        let cheapest = |lifted| optimum(lifted, &today.initial_c, targets, &today.actual, None).ok();
        let regret = lifted.and_then(cheapest).map(|cheapest| figures.cost - cheapest.cost);
        let design = &today.record.design;
        let foreign = building.plant.is_foreign();
        DayFigures {
            figures,
            worst_zones: WorstZones::find(&today.record, targets, limits),
            regret,
            early_kwh: early_kwh(&today.record, targets, model.step_s()),
            spectral_radius: design.spectral_radius.or(self.spectral_radius),
            fallback: design.fallback.is_some(),
            day_ahead: foreign.then(|| DayAheadErrors::compute(today, &building.believed)),
            metered: building.plant.metered(),
            exchange: design.exchange.as_ref().and_then(ExchangeFigures::sum_up),
            design_s: *design_s,
        }
    }
}

/// Heat supplied and removed before the first occupied time; 0 on a day without one \[kWh\].
fn early_kwh(record: &DayRecord, targets: &Targets, step_s: f64) -> f64 {
    // Occupation is defined at the ends of steps: the step that ends with the first occupied time is the last early step.
    let steps = targets.any_occupied().iter().position(|&occupied| occupied).map_or(0, |first| first + 1);
    let early_kw: f64 = record.heat_kw[..steps * targets.zones].iter().map(|kw| kw.abs()).sum();
    early_kw * step_s / 3600.0
}

/// Adds the step to the digests, and measures the day when it is over.
pub fn measure_building(
    building: Res<Building>,
    nodes: Query<(&Node, &Temperature)>,
    mut current_frame: ResMut<CurrentFrame>,
    mut measures: ResMut<BuildingMeasures>,
) {
    let Frame { building: Some(frame), events, .. } = &mut current_frame.0 else { return };
    measures.digest(frame);
    events.extend(measures.today.observe(frame, &building));
    if frame.step + 1 == building.steps_per_day() {
        let day = measures.day(&building);
        measures.days.push(day);
        let targets = building.targets.under(&building.today.actual.ambient_c);
        if let Some((_, history)) = &mut measures.whole_run {
            let mut end_c = vec![0.0; building.today.initial_c.len()];
            for (node, temperature) in &nodes {
                end_c[node.index] = temperature.0;
            }
            history.add(&targets, &building.today.actual, [&building.today.initial_c, &end_c]);
        }
        let zones = ZoneFigures::of_all(&building.today.record, &targets, building.model.step_s());
        measures.zone_days.push(zones);
        if let Some(why) = &building.today.record.design.fallback {
            let day = measures.days.len();
            let reason = format!("{}: {why}", why.consequence());
            measures.fallbacks.push(Fallback { day, reason });
        }
        if let Some(why) = &building.today.record.design.weaker_feedback {
            let day = measures.days.len();
            measures.weaker_feedbacks.push(Fallback { day, reason: why.to_string() });
        }
        measures.benchmark = building.plant.benchmark().cloned();
        frame.figures = Some(day);
    }
}
